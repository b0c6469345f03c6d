// From a scenario to its visibility functions: submit, progress, result, click a point, slider, curve.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {assertAccessible, assertContrast, openPage, picture} from './harness.mjs';
import {startServer} from './server.mjs';

const text = (locator) => locator.innerText();

async function submit(page, scenario) {
  await page.waitForSelector('.verdict-box .good');
  const area = page.locator('#scenario');
  assert.match(await area.inputValue(), /"name"/, 'an example stands in the editor');

  // A fault of the schema is marked where it stands, and its line can be gone to.
  const faulty = scenario.replace('"samples_per_pixel": 4}', '\n    "samples_per_pixel": "four"}');
  await area.fill(faulty);
  await page.waitForSelector('.faults');
  const line = faulty.split('\n').findIndex((l) => l.includes('"four"'));
  assert.equal(await text(page.locator('.numbers .bad')), String(line + 1));
  await assertAccessible(page);
  await assertContrast(page);
  await picture(page, 'flow-fault');
  await page.click('.faults button');
  assert.ok(await area.evaluate((a) => a === document.activeElement && a.value.slice(a.selectionStart).startsWith('"samples_per_pixel": "four"')));

  await area.fill(scenario);
  await page.waitForSelector('.verdict-box .good');
  assert.equal(await page.locator('.numbers .bad').count(), 0);
  await page.click('button.primary');
  await page.waitForURL(/#\/jobs\/j-/);
}

async function progress(page, mock) {
  await page.waitForSelector('.progress progress, #cell');
  await picture(page, 'flow-progress');
  if (!mock) return;
  const [job] = mock.jobs;
  const bar = page.locator('.progress progress');
  for (const [share, words] of [[0, '0 %'], [0.2, '20 %'], [0.4, '40 %']]) {
    mock.step(job);
    await page.waitForFunction(([v, t]) => document.querySelector('.progress progress')?.value === v &&
      document.querySelector('.stage-text').textContent.includes(t), [share, words]);
  }
  assert.equal(await bar.getAttribute('aria-label'), 'Progress of small');
  await assertAccessible(page);
  while (job.state !== 'succeeded') mock.step(job);
}

async function result(page) {
  await page.waitForSelector('#cell');
  assert.equal(await text(page.locator('h1')), 'small');
  assert.match(await text(page.locator('.purpose')), /<b>all<\/b>/, 'text of the scenario stays text');
  assert.equal(await page.locator('.cells tbody tr').count(), 6);
  await page.waitForSelector('.trade .mark-symbol path');

  // Every technique is a point; its pictures come by clicking it.
  const points = page.locator('.trade').first().locator('g.points_marks path, g.mark-symbol[class*="points"] path');
  assert.ok(await points.count() >= 6, `${await points.count()} points`);
  const chosen = await text(page.locator('#cell-title'));
  for (let i = 0; await text(page.locator('#cell-title')) === chosen; ++i) {
    assert.ok(i < await points.count(), 'no click on a point chose another technique');
    await points.nth(i).click({force: true});
  }
  await page.waitForFunction(() => [...document.querySelectorAll('#cell .strip img')].length === 4 &&
    [...document.querySelectorAll('#cell .strip img')].every((image) => image.naturalWidth > 0));
  const index = (await text(page.locator('#cell-title .index'))).trim();
  assert.equal((await text(page.locator('.cells tr.chosen .index'))).trim(), index);
  assert.match(await text(page.locator('#cell .command code')), /^shadowbench run small\.json --set 'sweeps=\{\}' --set 'techniques=\[/);

  // The same from the keyboard, in the table.
  const deep = page.locator('.cell-name', {hasText: 'deep tolerance=0.01'});
  await deep.focus();
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.querySelector('#cell-title').textContent.includes('deep tolerance=0.01'));
  assert.ok(await page.evaluate(() => document.activeElement.matches('.cell-name')), 'the focus stays');
  await page.waitForSelector('.histogram .mark-rect path');
}

async function measures(page) {
  const first = page.locator('.trade').first();
  await page.selectOption('.panel:has(#trade-title) select >> nth=0', 'curve.max');
  assert.match(await text(first.locator('figcaption')), /curve error, largest/);
  assert.match(await text(first), /Zeros stand at the edge/);
  await page.selectOption('.panel:has(#trade-title) select >> nth=1', 'image_floor');
  assert.match(await text(first), /image order, × floor →/);
  await page.selectOption('.panel:has(#trade-title) select >> nth=0', 'lookup.rms');
}

async function slider(page) {
  const element = page.locator('img-comparison-slider');
  await element.scrollIntoViewIfNeeded();
  const value = () => element.evaluate((e) => e.value);
  await page.waitForFunction(() => [...document.querySelectorAll('#compare img')].every((image) => image.naturalWidth > 0));

  await element.focus();
  await page.keyboard.down('ArrowRight');  // it moves as long as the key is held
  await page.waitForFunction(() => document.querySelector('img-comparison-slider').value > 55);
  await page.keyboard.up('ArrowRight');
  await page.locator('.knob').hover();  // waits until it has come to rest
  const knob = await page.locator('.knob').boundingBox();
  const [x, y] = [knob.x + knob.width / 2, knob.y + knob.height / 2];
  await page.mouse.down();
  await page.mouse.move(x - 150, y, {steps: 5});
  await page.mouse.up();
  assert.ok(await value() < 45, `dragged to ${await value()}`);
  assert.equal(await element.getAttribute('aria-valuenow'), String(Math.round(await value())));

  // Zoom and pan are shared by the two pictures and the map.
  const transforms = () => page.locator('.frame-content').evaluateAll((all) => all.map((e) => e.style.transform));
  await page.click('button[aria-label="Zoom in"]');
  const zoomed = await transforms();
  assert.equal(zoomed.length, 3);
  assert.match(zoomed[0], /scale\(1\.5\)/);
  assert.deepEqual(new Set(zoomed).size, 1);
  await page.locator('.pair > figure > .frame').focus();
  await page.keyboard.press('ArrowLeft');
  assert.notDeepEqual(await transforms(), zoomed);
  assert.equal(new Set(await transforms()).size, 1);
  await page.selectOption('#compare select >> nth=2', 'difference');
  await page.waitForSelector('#compare .ramp-difference');
  await page.click('button[aria-label="Whole picture"]');
  await page.selectOption('#compare select >> nth=2', 'heat');
}

async function curves(page) {
  await page.waitForSelector('#curves .curve-legend');
  await page.fill('#curves input[aria-label="x"]', '7');
  await page.fill('#curves input[aria-label="y"]', '9');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.querySelector('#curves .axis-title[aria-live]').textContent.includes('7, 9'));
  const rows = await page.locator('#curves .curve-legend tbody tr').count();
  assert.ok(rows >= 4, `${rows} functions`);
  const lines = page.locator('#curves .mark-line path');
  const drawn = await lines.count();
  assert.ok(drawn >= 3, `${drawn} lines`);
  await page.locator('#curves .curve-legend input').first().uncheck();
  await page.waitForFunction((n) => document.querySelectorAll('#curves .mark-line path').length === n, drawn - 1);

  const canvas = page.locator('#curves canvas');
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  await page.mouse.move(box.x + box.width * 0.51, box.y + box.height * 0.26);
  await page.waitForFunction(() => document.querySelector('#curves .axis-title[aria-live]').textContent.includes('16, 8'));
  await canvas.focus();
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction(() => document.querySelector('#curves .axis-title[aria-live]').textContent.includes('17, 8'));
}

async function variants(page, mock) {
  const select = page.locator('.switch select').first();
  assert.deepEqual(await select.locator('option').allInnerTexts(), ['rays.samples_per_pixel = 4', 'rays.samples_per_pixel = 16']);
  await page.locator('.switch select').nth(1).selectOption({label: 'fill'});
  await page.waitForFunction(() => document.querySelector('#curves figcaption').textContent.includes('fill'));
  if (mock) {  // this light's map is coloured there: each channel has a function of its own
    const path = () => page.locator('#curves .mark-line path').first().getAttribute('d');
    await page.waitForSelector('#curves .choice:has-text("Channel")');
    const red = await path();
    await page.selectOption('#curves .choice:has-text("Channel") select', '1');
    await page.waitForFunction((before) => document.querySelector('#curves .mark-line path').getAttribute('d') !== before, red);
  }
  await select.selectOption({label: 'rays.samples_per_pixel = 16'});
  await page.waitForFunction(() => document.querySelector('main').textContent.includes('Pictures were made of another variant'));
  assert.match(await text(page.locator('#cell .command code')), /--set \/rays\/samples_per_pixel=16/);
  await select.selectOption({label: 'rays.samples_per_pixel = 4'});
  await page.waitForSelector('#compare');
}

async function remove(page) {
  await page.click('nav a[href="#/jobs"]');
  await page.waitForSelector('.jobs tbody tr');
  await picture(page, 'flow-jobs');
  await page.click('.jobs tbody tr button');
  await page.waitForSelector('.empty:not([hidden])');
}

export default async function run(options) {
  const server = await startServer(options);
  try {
    const scenario = readFileSync(join(options.here, 'small.json'), 'utf8');
    const refused = [/status of 4(00|22)/];  // the fault that is typed
    const {page, close} = await openPage(options.browser, {allowed: server.url, expected: refused});
    await page.goto(server.url);
    await submit(page, scenario);
    await progress(page, server.mock);
    await result(page);
    await measures(page);
    await slider(page);
    await curves(page);
    await variants(page, server.mock);
    const address = page.url();
    for (const scheme of ['light', 'dark']) {
      for (const width of [1280, 400]) {
        const look = await openPage(options.browser, {scheme, width, allowed: server.url});
        await look.page.goto(address);
        await look.page.waitForSelector('#curves .curve-legend');
        await look.page.waitForSelector('.trade .mark-symbol path');
        await assertAccessible(look.page);
        await assertContrast(look.page);
        await picture(look.page, `flow-result-${scheme}-${width}`);
        await look.close();
      }
    }
    await remove(page);
    await close();
  } finally {
    await server.stop();
  }
}
