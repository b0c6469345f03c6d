// From a scenario to its visibility functions: submit, progress, result, click a point, slider, curve; then a comparison and
// a queue.
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

const legendAt = (page, words) => page.waitForFunction((w) => document.querySelector('#curves .curve-title').textContent.includes(w), words);

async function choosePixel(page, x, y) {
  await page.fill('#curves input[aria-label="x"]', String(x));
  await page.fill('#curves input[aria-label="y"]', String(y));
  await page.click('#curves button:has-text("Show")');
  await legendAt(page, `${x}, ${y}`);
}

// Of a linear value, as the picture of the map has it at a pixel.
function pictureAt(page, x, y) {
  return page.locator('#curves .grid img').evaluate((image, [px, py]) => {
    const canvas = document.createElement('canvas');
    canvas.width = image.naturalWidth;
    canvas.height = image.naturalHeight;
    const paint = canvas.getContext('2d');
    paint.drawImage(image, 0, 0);
    const v = paint.getImageData(px, image.naturalHeight - 1 - py, 1, 1).data[0] / 255;
    return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  }, [x, y]);
}

async function curves(page, mock) {
  await page.waitForSelector('#curves .curve-legend');
  await choosePixel(page, 7, 9);
  const rows = await page.locator('#curves .curve-legend tbody tr').count();
  assert.ok(rows >= 4, `${rows} functions`);
  const lines = page.locator('#curves .mark-line path');
  const drawn = await lines.count();
  assert.ok(drawn >= 3, `${drawn} lines`);
  await page.locator('#curves .curve-legend input').first().uncheck();
  await page.waitForFunction((n) => document.querySelectorAll('#curves .mark-line path').length === n, drawn - 1);

  // Pixels are chosen over a picture of the map, with the pointer and from the keyboard, and are spoken.
  const grid = page.locator('#curves .grid');
  await grid.scrollIntoViewIfNeeded();
  await page.waitForFunction(() => document.querySelector('#curves .grid img').naturalWidth === 32);
  const box = await grid.boundingBox();
  await page.mouse.move(box.x + box.width * 0.51, box.y + box.height * 0.26);
  await legendAt(page, '16, 23');
  await grid.focus();
  await page.keyboard.press('ArrowRight');
  await legendAt(page, '17, 23');
  await page.keyboard.press('ArrowUp');
  await legendAt(page, '17, 24');
  await page.keyboard.press('Shift+ArrowDown');
  await legendAt(page, '17, 16');
  assert.match(await grid.getAttribute('aria-label'), /Map of light key, 32 by 32 pixels, at 17, 16\./);
  const marker = await page.locator('#curves .marker').boundingBox();
  assert.ok(Math.abs(marker.x + marker.width / 2 - box.x - box.width * 17.5 / 32) < 2, 'the marker is in its column');
  assert.ok(Math.abs(marker.y + marker.height / 2 - box.y - box.height * 15.5 / 32) < 2, 'the marker is in its row');
  if (mock) return;
  for (const [x, y] of [[17, 16], [2, 29], [14, 20], [29, 13]]) {
    await choosePixel(page, x, y);
    const said = /: ([\d.]+) % of the light/.exec(await text(page.locator('#status')));
    assert.ok(Math.abs(Number(said[1]) / 100 - await pictureAt(page, x, y)) < 0.01, `${said[0]} at ${x}, ${y}, and ${await pictureAt(page, x, y)} in the picture`);
  }
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
  }
  await select.selectOption({label: 'rays.samples_per_pixel = 16'});
  await page.waitForFunction(() => document.querySelector('main').textContent.includes('Pictures were made of another variant'));
  assert.match(await text(page.locator('#cell .command code')), /--set \/rays\/samples_per_pixel=16/);
  // Nor of its map: it is painted by what was asked for.
  assert.equal(await page.locator('#curves .grid img').isVisible(), false);
  await page.click('#curves button:has-text("Survey")');
  await page.waitForFunction(() => {
    const canvas = document.querySelector('#curves canvas');
    return canvas.getContext('2d').getImageData(canvas.width - 1, 0, 1, 1).data[3] === 255;
  });
  await select.selectOption({label: 'rays.samples_per_pixel = 4'});
  await page.waitForSelector('#compare');
}

// The same result against itself, then against a file in which a map is larger.
async function comparison(page, mock) {
  const result = await page.evaluate(async () => (await fetch(`/v1/${location.hash.slice(2)}/result`)).json());
  await page.click('.links a:has-text("Compare with another")');
  await page.waitForSelector('.side select option:checked:not([value=""])', {state: 'attached'});
  const current = page.locator('.side', {hasText: 'Current'});
  await current.locator('select').selectOption({index: 1});
  await page.waitForSelector('.outcome');
  if (!mock) assert.match(await text(page.locator('.outcome')), /nothing is slower, larger or less accurate/);
  result.variants[0].lights[0].cells[1].bytes *= 2;
  await current.locator('input').setInputFiles({name: 'mine.json', mimeType: 'application/json', buffer: Buffer.from(JSON.stringify(result))});
  await page.waitForSelector('.outcome.bad-title');
  assert.match(await text(page.locator('.lines')), /deep tolerance=0\.01\s+bytes\s+✕ larger/);
  await page.selectOption('.panel:has(#verdicts-title) select', 'all');
  assert.ok(await page.locator('.lines tbody tr').count() > 8);
  await looks(page, 'flow-compare');
  await current.locator('input').setInputFiles({name: 'no.json', mimeType: 'application/json', buffer: Buffer.from('{')});
  await page.waitForFunction(() => document.querySelector('.problem').textContent === 'no.json is no JSON.');
}

// In both colour schemes, wide and narrow.
async function looks(page, name) {
  for (const colorScheme of ['light', 'dark'])
    for (const width of [1280, 400]) {
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
  const slow = {...JSON.parse(scenario), name: 'slow', timing: {repetitions: 10000, lookups: 4096}};
  for (const seed of [1, 2])
    await page.evaluate((body) => fetch('/v1/jobs', {method: 'POST', headers: {'Content-Type': 'application/json'}, body}),
      JSON.stringify({scenario: {...slow, rays: {...slow.rays, seed}}}));
  if (mock) for (const _ of [1, 2]) mock.step(mock.jobs[1]);
  await page.click('nav a[href="#/jobs"]');
  await page.waitForSelector('.jobs .state-queued');
  await page.waitForFunction(() => /\d %\s+[a-z]/.test(document.querySelector('.jobs tr:has(.state-running) .what')?.textContent));
  await looks(page, 'flow-jobs');
  await page.click('.jobs tr:has(.state-running) a');
  await page.waitForFunction(() => /\d %\s+[a-z]/.test(document.querySelector('.stage-text')?.textContent));
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
    const address = page.url();
    for (const scheme of ['light', 'dark']) {
      for (const width of [1280, 400]) {
        const look = await openPage(options.browser, {scheme, width, allowed: server.url});
        await look.page.goto(address);
        await look.page.waitForSelector('#curves .curve-legend');
        await look.page.waitForSelector('.trade .mark-symbol path');
        await look.page.waitForFunction(() => document.querySelector('#curves .grid img').naturalWidth > 0);
        await choosePixel(look.page, 17, 18);  // below the sphere and the layer
        if (!server.mock) assert.ok(Number(/: ([\d.]+) %/.exec(await text(look.page.locator('#status')))[1]) < 40, 'an occluded pixel');
        if (width === 400) await narrowTable(look.page);
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
