// From a scenario to its visibility functions: submit, progress, result, click a point, slider, curve; then a comparison and
// a queue.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {assertAccessible, assertContrast, openPage, picture} from './harness.mjs';
import {choosePixel, curves, spoken} from './pixels.mjs';
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
  assert.equal(await page.locator('.page-head select option:checked').innerText(), 'your own');
  await looks(page, 'flow-fault');
  await page.click('.faults button');
  assert.ok(await area.evaluate((a) => a === document.activeElement && a.value.slice(a.selectionStart).startsWith('"samples_per_pixel": "four"')));

  await area.fill(scenario);
  await page.waitForSelector('.verdict-box .good');
  assert.equal(await page.locator('.numbers .bad').count(), 0);
  await page.click('#run');
  await page.waitForURL(/#\/jobs\/j-/);
}

async function progress(page, mock) {
  await page.waitForSelector('.progress progress, #cell');
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
  assert.match(await text(first), /Zeros are drawn at the edge/);
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
  assert.equal(zoomed.length, 5);
  assert.match(zoomed[0], /scale\(1\.5\)/);
  assert.deepEqual(new Set(zoomed).size, 1);
  await page.locator('.pair > figure > .frame').first().focus();
  await page.keyboard.press('ArrowLeft');
  assert.notDeepEqual(await transforms(), zoomed);
  assert.equal(new Set(await transforms()).size, 1);
  await page.selectOption('#compare select >> nth=2', 'difference');
  await page.waitForSelector('#compare .ramp-difference');
  await page.click('button[aria-label="Whole picture"]');
  await page.selectOption('#compare select >> nth=2', 'heat');
}

// The table of figures scrolls within its place, and its first column stays.
async function narrowTable(page) {
  const {scrolls, stays, share, cut} = await page.locator('.scroll:has(> .cells)').first().evaluate((place) => {
    place.scrollLeft = place.scrollWidth;
    const [outer, head] = [place, place.querySelector('tbody th')].map((e) => e.getBoundingClientRect());
    const names = [...place.querySelectorAll('tbody th')];
    const all = {scrolls: place.scrollWidth > place.clientWidth && place.scrollLeft > 0, stays: Math.abs(head.left - outer.left) < 2, share: head.width / outer.width,
      cut: names.some((th) => th.scrollWidth > th.clientWidth + 1)};
    place.scrollLeft = 0;
    return all;
  });
  assert.ok(scrolls, 'the table scrolls');
  assert.ok(stays && !cut, 'names of techniques stay in view, whole');
  assert.ok(share < 0.6, `names take ${share} of the width`);
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
    assert.match(page.url(), /channel=green/);
  }
  await select.selectOption({label: 'rays.samples_per_pixel = 16'});
  await page.waitForFunction(() => document.querySelector('main').textContent.includes('The pictures show another variant'));
  assert.match(await text(page.locator('#cell .command code')), /--set \/rays\/samples_per_pixel=16/);
  // Nor of its map: it is painted by what was asked for.
  assert.equal(await page.locator('#curves .grid img').isVisible(), false);
  await page.click('#curves button:has-text("Survey")');
  await page.waitForSelector('#curves button:has-text("Stop")');
  await page.waitForSelector('#curves button:has-text("Survey")');
  const corner = await page.locator('#curves canvas').evaluate((canvas) => canvas.getContext('2d').getImageData(canvas.width - 1, 0, 1, 1).data[3]);
  assert.equal(corner, 255, 'the last pixel is painted');
  await select.selectOption({label: 'rays.samples_per_pixel = 4'});
  await page.waitForSelector('#compare');
}

// The same result against itself, then against a file in which a map is larger.
async function comparison(page, mock) {
  const result = await page.evaluate(async () => (await fetch(`/v1/${location.hash.slice(2).split('?')[0]}/result`)).json());
  await page.click('.links a:has-text("Compare with another")');
  await page.waitForSelector('.side select option:checked:not([value=""])', {state: 'attached'});
  const current = page.locator('.side', {hasText: 'Current'});
  await current.locator('select').selectOption({index: 1});
  await page.waitForSelector('.outcome');
  if (!mock) assert.match(await text(page.locator('.outcome')), /^Nothing is slower, larger or less accurate\.$/);
  result.variants[0].lights[0].cells[1].bytes *= 2;
  await current.locator('input').setInputFiles({name: 'mine.json', mimeType: 'application/json', buffer: Buffer.from(JSON.stringify(result))});
  await page.waitForSelector('.outcome.bad-title');
  assert.match(await text(page.locator('.lines')), /deep tolerance=0\.01\s+bytes\s+✕ larger/);
  await page.selectOption('.panel:has(#verdicts-title) select', 'all');
  assert.ok(await page.locator('.lines tbody tr').count() > 8);
  await page.selectOption('.panel:has(#verdicts-title) select', 'differ');
  await looks(page, 'flow-compare');
  await current.locator('input').setInputFiles({name: 'no.json', mimeType: 'application/json', buffer: Buffer.from('{')});
  await page.waitForFunction(() => document.querySelector('.problem').textContent === 'no.json is not JSON.');
}

// In both colour schemes, at all widths.
async function looks(page, name) {
  for (const colorScheme of ['light', 'dark'])
    for (const width of [1440, 1024, 390]) {
      await page.emulateMedia({colorScheme});
      await page.setViewportSize({width, height: 900});
      await assertAccessible(page);
      await assertContrast(page);
      await picture(page, `${name}-${colorScheme}-${width}`);
    }
  await page.emulateMedia({colorScheme: 'light'});
  await page.setViewportSize({width: 1280, height: 900});
}

// One job that takes a while, and one behind it.
async function queue(page, scenario, mock) {
  const slow = {...JSON.parse(scenario), name: 'slow', timing: {repetitions: 500, lookups: 4096}};
  for (const seed of [1, 2])
    assert.equal(await page.evaluate(async (body) => (await fetch('/v1/jobs', {method: 'POST', headers: {'Content-Type': 'application/json'}, body})).status,
      JSON.stringify({scenario: {...slow, rays: {...slow.rays, seed}}})), 202);
  if (mock) for (const _ of [1, 2]) mock.step(mock.jobs[1]);
  await page.click('nav a[href="#/jobs"]');
  await page.waitForSelector('.jobs .state-queued');
  await page.waitForFunction(() => /\d %: [a-z]/.test(document.querySelector('.jobs tr:has(.state-running) .what')?.textContent));
  await looks(page, 'flow-jobs');
  await page.click('.jobs tr:has(.state-running) a');
  await page.waitForFunction(() => /\d %: [a-z]/.test(document.querySelector('.stage-text')?.textContent));
  await looks(page, 'flow-progress');
  await page.click('nav a[href="#/jobs"]');
  for (let left = 2; left > 0; --left) {
    await page.locator('.jobs button:has-text("Cancel")').last().click();
    await page.waitForFunction((n) => document.querySelectorAll('.jobs .state-cancelled').length === n, 3 - left);
  }
}

async function remove(page) {
  for (let left = await page.locator('.jobs tbody tr').count(); left > 0; --left) {
    await page.locator('.jobs tbody tr button').last().click();
    await page.waitForFunction((n) => document.querySelectorAll('.jobs tbody tr').length === n, left - 1);
  }
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
    await curves(page, server.mock);
    await variants(page, server.mock);
    const [address] = page.url().split('?');  // as it is first shown
    for (const scheme of ['light', 'dark']) {
      for (const width of [1440, 1024, 390]) {
        const look = await openPage(options.browser, {scheme, width, allowed: server.url});
        await look.page.goto(address);
        await look.page.waitForSelector('#curves .curve-legend');
        await look.page.waitForSelector('.trade .mark-symbol path');
        await look.page.waitForFunction(() => document.querySelector('#curves .grid img').naturalWidth > 0);
        await choosePixel(look.page, 17, 18);  // below the sphere and the layer
        if (!server.mock) assert.ok(await spoken(look.page) < 0.4, 'an occluded pixel');
        if (width === 390) await narrowTable(look.page);
        await assertAccessible(look.page);
        await assertContrast(look.page);
        await picture(look.page, `flow-result-${scheme}-${width}`);
        await look.close();
      }
    }
    await comparison(page, server.mock);
    await queue(page, scenario, server.mock);
    await remove(page);
    await close();
  } finally {
    await server.stop();
  }
}
