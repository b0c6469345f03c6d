// The report and the history as files: all is there, and nothing is loaded.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {assertAccessible, assertContrast, openPage, picture} from './harness.mjs';
import {makeFixture} from './server.mjs';

async function each(browser, file, look) {
  for (const scheme of ['light', 'dark'])
    for (const width of [1440, 1024, 390]) {
      const address = pathToFileURL(file).href;
      const {page, close} = await openPage(browser, {scheme, width, allowed: address});
      await page.goto(address);
      await look(page, `${scheme}-${width}`);
      await assertAccessible(page, {axe: scheme === 'light', focus: width !== 1024});  // as in states.mjs
      await assertContrast(page);
      await close();
    }
}

// Changes the result that the folder holds.
async function report(options, folder) {
  const result = JSON.parse(readFileSync(join(folder, 'result.json'), 'utf8'));
  result.name = '</script><script>hacked = 1</script><img src=x onerror="hacked = 1">';
  result.variants[0].lights[0].cells[1].label = '<img src=x onerror="hacked = 1">';
  // A technique that broke its promise has no times; what does not exist is null.
  Object.assign(result.variants[0].lights[0].cells[2], {status: 'failed', verdict: 'failed', reason: 'rises by 0.5', times: undefined, curve_error: null, lookup_error: {rms: null}});
  writeFileSync(join(folder, 'result.json'), JSON.stringify(result));
  const named = join(folder, 'images', 'images.json'), images = JSON.parse(readFileSync(named, 'utf8'));
  images.techniques[1].label = result.variants[0].lights[0].cells[1].label;
  writeFileSync(named, JSON.stringify(images));
  execFileSync(options.program, ['report', folder], {stdio: 'ignore'});
  await each(options.browser, join(folder, 'report.html'), async (page, name) => {
    await page.waitForSelector('.trade .mark-symbol path');
    await page.waitForFunction(() => [...document.querySelectorAll('img')].length >= 7 &&
      [...document.querySelectorAll('img')].every((image) => image.naturalWidth > 0));
    assert.equal(await page.locator('h1').innerText(), result.name);
    assert.equal(await page.evaluate(() => globalThis.hacked), undefined);
    assert.equal(await page.locator('#curves').count(), 0, 'nobody can be asked for functions');
    assert.match(await page.locator('.trade').first().innerText(), /Not drawn: 3 failed\./);
    await page.locator('.cell-name').nth(2).click();
    await page.waitForFunction(() => document.querySelector('#cell .why').textContent === 'rises by 0.5');
    assert.match(await page.locator('.cells tr.chosen').innerText(), /✕ failed/);
    await page.locator('.cell-name', {hasText: 'fourier'}).click();
    await page.waitForFunction(() => document.querySelector('#cell-title').textContent.includes('fourier'));
    await picture(page, `report-${name}`);
  });
}

function historyOf() {
  const runs = Array.from({length: 12}, (_, i) => ({started: `2026-11-${String(i + 10)}T08:00:00Z`, commit: `abcdef${i}`, file: `r${i}/result.json`}));
  const measure = (name, unit, of, drift) => ({name, unit, drift, points: runs.map((run, i) => ({run: run.started, commit: run.commit, ...of(i)}))});
  const drift = {from: 10, to: 10.8, ratio: 1.08, since: runs[7].started};
  return {
    runs,
    cells: ['deep tolerance=0.02', 'avsm'].map((title, k) => ({title: `quickstart / key / ${title}`, measures: [
      measure('lookup random', 'ns', (i) => ({value: 10 + (i > 6 && k === 0 ? 0.8 : 0) + Math.sin(i) * 0.1, low: 9.8, high: 11.1}), k === 0 ? drift : null),
      measure('bytes', 'B', () => ({value: 4096, low: null, high: null}), null),
      measure('lookup_error.rms', '', (i) => ({value: i === 3 ? null : 0.03, low: null, high: null}), null),
    ]})),
  };
}

// As document.cpp puts one together.
function pageOf(pages, script, data) {
  const read = (name) => readFileSync(join(pages, name), 'utf8');
  return '<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="color-scheme" content="light dark">' +
    `<meta name="viewport" content="width=device-width"><title>A page</title><style>${read('style.css')}</style></head><body><main id="main"></main>` +
    `<script type="application/json" id="data">${JSON.stringify(data)}</script><script>${read(script)}</script></body></html>`;
}

// A recommendation as a file begins with its answer, at the error that was asked for.
async function recommendation(options, folder) {
  const result = JSON.parse(readFileSync(join(folder, 'result.json'), 'utf8'));
  const best = {technique: 'deep', setting: 'deep tolerance=0.02', confirmed: true, error: [0.021, 0.024], lookup_ns: 6.5, bytes: 4096, build_ms: 2, part: {rays: {}, techniques: [{type: 'deep'}]}};
  result.recommendation = {light: 'key', measure: 'rms', goal: {error: 0.025, cheapest: ['bytes'], at_most: {}, budget_seconds: 9}, end: 'complete', measured: [], confirmed: [],
    families: [{technique: 'deep', name: 'deep', axes: [], mapless: false}],
    answer: {reached: true, too_early: null, without_map: null, closest: null, cheapest: [{cost: 'bytes', ...best, runner_up: null, perhaps: null}], missed: [], broken: []}};
  const file = join(folder, 'recommendation.html');
  writeFileSync(file, pageOf(options.pages, 'report.js', {result, images: null, pictures: {}}));
  await each(options.browser, file, async (page, name) => {
    await page.waitForSelector('.cells tbody tr');
    assert.match(await page.locator('main .panel').first().innerText(), /^With an error of at most 0\.025[^]*Fewest bytes\s+deep tolerance=0\.02\s+4 KiB/);
    assert.equal(await page.locator('#budget').inputValue(), '0.025');
    assert.equal(await page.locator('main .panel').first().locator('button').count(), 0, 'nobody can be asked');
    await picture(page, `report-recommendation-${name}`);
  });
}

async function history(options, folder) {
  const file = join(folder, 'history.html');
  writeFileSync(file, pageOf(options.pages, 'history.js', historyOf()));
  await each(options.browser, file, async (page, name) => {
    await page.waitForSelector('.trend .mark-symbol path');
    assert.match(await page.locator('.purpose').innerText(), /2 cells over 12 runs.* 1 measure drifts\./);
    assert.equal(await page.locator('.trend').count(), 6);
    assert.match(await page.locator('.drift').innerText(), /drifts: 10 → 10\.8 \(1\.08 ×\) since 17 Nov 2026/);
    await picture(page, `history-${name}`);
    await page.check('.check input');
    assert.equal(await page.locator('.trend').count(), 1);
    await page.selectOption('.choices select', 'bytes');
    assert.match(await page.locator('.empty').innerText(), /No measure fits/);
  });
}

// As C writes them, as the terminal does: with all digits before the point, such as times on a busy machine have.
function written(values, digits) {
  const wanted = values.map((v) => (v >= 10 ** digits ? '%.0f' : `%.${digits}g`)).join('\\n');
  return execFileSync('printf', [wanted, ...values.map(String)], {encoding: 'utf8'}).trim().split('\n').map(Number);
}

// What the terminal says, the report says.
async function numbers(options, folder) {
  execFileSync(options.program, ['report', folder], {stdio: 'ignore'});
  const address = pathToFileURL(join(folder, 'report.html')).href;
  const {page, close} = await openPage(options.browser, {allowed: address});
  const noises = [...readFileSync(join(folder, 'table.txt'), 'utf8').matchAll(/0\.5\/sqrt\(N\) ([\d.]+)/g)].map(([, noise]) => noise);
  assert.deepEqual(noises, ['0.25', '0.25', '0.12', '0.12'], '0.125 lies in the middle');
  const {variants} = JSON.parse(readFileSync(join(folder, 'result.json'), 'utf8'));
  for (const [i, noise] of noises.entries()) {
    await page.goto(`${address}#?variant=${i >> 1}&light=${i & 1}`);
    await page.reload();
    await page.waitForSelector('.cells tbody tr');
    assert.match(await page.locator('section[aria-label="Capture"]').innerText(), new RegExp(`0\\.5/√N ${noise.replace('.', '\\.')},`));
    const shown = await page.locator('.cells tbody tr').evaluateAll((all) => all.map((tr) => [...tr.querySelectorAll('td')].map((td) => Number(td.innerText.replace(/[~,]/g, '')))));
    const {cells} = variants[i >> 1].lights[i & 1];
    const errors = (cell) => [cell.curve_error.max, cell.lookup_error.rms, cell.lookup_error.p99, cell.lookup_error.max], times = (cell) => ['image', 'random'].map((order) => cell.times[`lookup_${order}_order`].ns.median);
    assert.deepEqual(shown.map((row) => row.slice(9, 13)).flat(), written(cells.flatMap(errors), 2));
    assert.deepEqual(shown.map((row) => [row[1], row[3]]).flat(), written(cells.flatMap(times), 3));
  }
  // Its address holds what it shows, as a file has no server to ask.
  await page.locator('.cell-name', {hasText: 'fourier'}).click();
  await page.reload();
  await page.waitForFunction(() => document.querySelector('#cell-title')?.textContent.includes('fourier'));
  await page.goBack();
  await page.waitForFunction(() => !document.querySelector('#cell-title').textContent.includes('fourier'));
  // Back from what is chosen first in a report whose address says nothing yet.
  await page.goto('about:blank');
  await page.goto(address);
  const first = await page.locator('#cell-title').innerText();
  await page.locator('.cell-name', {hasText: 'fourier'}).click();
  await page.goBack();
  await page.waitForFunction((title) => document.querySelector('#cell-title').innerText === title, first);
  await close();
}

export default async function run(options) {
  const folder = makeFixture(options);
  await numbers(options, folder);
  await history(options, folder);
  await recommendation(options, folder);
  await report(options, folder);
}
