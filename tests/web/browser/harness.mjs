// A browser, a page in it that may not complain, and small helpers. No test framework: a failed assertion ends the run.
import assert from 'node:assert/strict';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

export const deadline = 60_000;  // milliseconds for anything to appear: generous, for sanitizers on busy machines

// Flags that keep it off the network and let it run as root.
const flags = [
  '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync',
];

export function temporaryFolder(name) {
  const folder = mkdtempSync(join(tmpdir(), `shadowbench-${name}-`));
  process.on('exit', () => rmSync(folder, {recursive: true, force: true}));
  return folder;
}

let axe = '';  // the script of axe-core

export async function startBrowser(modules, chromium) {
  const require = createRequire(join(modules, 'package.json'));
  axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
  const {chromium: driver} = require('playwright-core');
  return driver.launch({executablePath: chromium, headless: true, args: flags});
}

// A page; every message of its console that is a warning or an error, every exception, refused policy and request to
// another place is kept. `expected`: patterns of messages that the test provokes.
export async function openPage(browser, {scheme = 'light', width = 1280, height = 900, expected = [], allowed} = {}) {
  const context = await browser.newContext({colorScheme: scheme, viewport: {width, height}, reducedMotion: 'reduce'});
  const page = await context.newPage();
  page.setDefaultTimeout(deadline);
  const complaints = [];
  const complain = (text) => { if (!expected.some((pattern) => pattern.test(text))) complaints.push(text); };
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) complain(message.text()); });
  page.on('pageerror', (error) => complain(`exception: ${error.stack ?? error}`));
  page.on('request', (request) => {
    const url = request.url();
    if (!url.startsWith('data:') && !url.startsWith('blob:') && !url.startsWith(allowed)) complain(`loads ${url}`);
  });
  return {page, close: async () => { assert.deepEqual(complaints, []); await context.close(); }};
}

// Screenshots, when a folder for them is told.
export async function picture(page, name) {
  if (!process.env.SHADOWBENCH_SCREENSHOTS) return;
  await page.screenshot({path: join(process.env.SHADOWBENCH_SCREENSHOTS, `${name}.png`), fullPage: true});
}

// No violation of axe-core's rules. Contrast is left to assertContrast, which sees the texts of plots as well.
async function assertAxe(page) {
  await page.evaluate(`if (!window.axe) { ${axe} }`);
  const found = await page.evaluate(async () => (await window.axe.run(document, {rules: {'color-contrast': {enabled: false}}, resultTypes: ['violations']})).violations
    .map(({id, help, nodes}) => `${id}: ${help}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 120)).join(' | ')}`));
  assert.deepEqual(found, []);
}

// Plots are drawn again after a change of the window or the colours. What never fits is found by the assertion that follows.
async function drawn(page) {
  await page.evaluate(() => new Promise((resolve) => { requestAnimationFrame(() => requestAnimationFrame(resolve)); }));
  await page.waitForFunction(() => [...document.querySelectorAll('.plot svg')].every((svg) => {
    const a = svg.getBoundingClientRect(), b = svg.closest('.plot').getBoundingClientRect();
    return a.left >= b.left - 1 && a.right <= b.right + 1 && a.top >= b.top - 1 && a.bottom <= b.bottom + 1;
  }), null, {timeout: 10_000}).catch(() => {});
}

// Every control has a name and shows when it has the focus, every picture and plot a text, ids are there once, plots stand
// where they belong, their labels cover neither marks nor each other, and the page does not scroll sideways.
// `axe`: with axe-core's rules, `focus`: with the focus of each control. These take the longest.
export async function assertAccessible(page, {axe: rules = true, focus: every = rules} = {}) {
  await drawn(page);
  const faults = await page.evaluate((focus) => {
    const found = [];
    const seen = new Set();
    for (const {id} of document.querySelectorAll('[id]')) seen.has(id) ? found.push(`two elements #${id}`) : seen.add(id);
    const named = (e) => e.getAttribute('aria-label') || e.getAttribute('aria-labelledby') || e.textContent.trim() || e.labels?.length || e.title;
    for (const e of document.querySelectorAll('button, a[href], input, select, textarea, progress, [role="slider"], [role="img"], [tabindex="0"]'))
      if (e.checkVisibility() && !named(e)) found.push(`no name: ${e.outerHTML.slice(0, 90)}`);
    const before = document.activeElement;
    for (const e of focus ? document.querySelectorAll('button:enabled, a[href], input:enabled, select:enabled, [tabindex="0"]') : []) {
      if (!e.checkVisibility()) continue;
      e.focus({focusVisible: true, preventScroll: true});
      if (document.activeElement !== e || getComputedStyle(e).outlineStyle === 'none') found.push(`no focus to see: ${e.outerHTML.slice(0, 90)}`);
    }
    document.activeElement.blur();
    if (before !== document.body) before.focus({preventScroll: true});
    for (const e of document.querySelectorAll('img')) if (!e.hasAttribute('alt')) found.push(`no alt: ${e.outerHTML.slice(0, 90)}`);
    for (const e of document.querySelectorAll('.plot svg')) {
      const a = e.getBoundingClientRect(), b = e.closest('.plot').getBoundingClientRect();
      if (a.top < b.top - 1 || a.bottom > b.bottom + 1 || a.left < b.left - 1 || a.right > b.right + 1) found.push('a plot outside its place');
    }
    const overlap = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;
    for (const plot of document.querySelectorAll('.plot svg')) {
      const boxes = (selector) => [...plot.querySelectorAll(selector)].map((e) => ({text: e.textContent, box: e.getBoundingClientRect()}));
      const labels = boxes('.labels_marks text');
      const all = [...labels, ...boxes('.mark-symbol.role-mark path')];
      labels.forEach((label, i) => all.slice(i + 1).forEach((other) => { if (overlap(label.box, other.box)) found.push(`"${label.text}" covers ${other.text || 'a mark'}`); }));
    }
    for (const what of ['main', 'h1']) if (document.querySelectorAll(what).length !== 1) found.push(`not one ${what}`);
    for (const e of document.querySelectorAll('.panel :is(select, input, button)'))
      if (e.checkVisibility() && !e.closest('.scroll') && e.getBoundingClientRect().right > e.closest('.panel').getBoundingClientRect().right - 8) found.push(`outside its panel: ${e.outerHTML.slice(0, 90)}`);
    const {scrollWidth} = document.scrollingElement;
    if (scrollWidth > innerWidth) found.push(`wider than the window: ${scrollWidth} > ${innerWidth}`);
    return found;
  }, every);
  assert.deepEqual(faults, []);
  if (rules) await assertAxe(page);
}

// Contrast of every visible text with what it stands on, as WCAG 2.2 counts it: at least 4.5 to 1 (3 to 1 when large).
export async function assertContrast(page) {
  const faults = await page.evaluate(() => {
    const numbers = (text) => (text.match(/[\d.]+/g) ?? []).map(Number);
    const light = ([r, g, b]) => [r, g, b].map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
      .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
    const behind = (e) => {
      for (; e; e = e.parentElement) {
        const [r, g, b, a = 1] = numbers(getComputedStyle(e).backgroundColor);
        if (a > 0.99) return [r, g, b];
      }
      return [255, 255, 255];
    };
    const found = [];
    const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
      const e = texts.currentNode.parentElement;
      if (!texts.currentNode.data.trim() || !e.checkVisibility() || e.closest('.hidden, .skip, :disabled, .marks, option, script, style')) continue;
      const style = getComputedStyle(e), size = parseFloat(style.fontSize);
      const a = light(numbers(e.namespaceURI.endsWith('svg') ? style.fill : style.color)), b = light(behind(e));
      const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      if (contrast < (size >= 24 ? 3 : 4.5)) found.push(`${contrast.toFixed(2)}: ${texts.currentNode.data.trim().slice(0, 40)} (${e.className.baseVal ?? e.className})`);
    }
    return [...new Set(found)];
  });
  assert.deepEqual(faults, []);
}
