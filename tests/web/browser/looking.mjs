// A result: the answer, the error that is allowed, what the address holds, pictures and functions.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {openPage} from './harness.mjs';

export const looking = {};
const text = (page, selector) => page.locator(selector).first().innerText();
const stateOf = (page) => page.evaluate(() => Object.fromEntries(new URLSearchParams(location.hash.split('?')[1] ?? '')));

// Waits until the address says so.
const holds = (page, name, value) => page.waitForFunction(([n, v]) => (new URLSearchParams(location.hash.split('?')[1] ?? '').get(n) ?? '') === v, [name, value]);

async function open({page, url, mock}, query = '') {
  const job = mock.job('succeeded');
  await page.goto(`${url}#/jobs/${job.id}${query}`);
  await page.waitForSelector('.trade .mark-symbol path');
  await page.waitForSelector('#curves .curve-legend');
  await page.waitForSelector('.budget-line');
  return job;
}

looking['the answer first, at an error that is dragged'] = async (given) => {
  const {page} = given;
  await open(given);
  const first = await page.evaluate(() => document.querySelector('main .panel:not(.quiet-panel)').className);
  assert.match(first, /answer/);
  assert.match(await text(page, '.answers'), /Fastest[^]*ns, [\d.]+ [KM]iB, error 0\.\d+/);
  // Dragging the line down leaves fewer, and at last none.
  const line = page.locator('.budget-line').first(), before = Number(await line.getAttribute('aria-valuenow'));
  await line.scrollIntoViewIfNeeded();
  const box = await line.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + 600, {steps: 4});
  await page.mouse.up();
  const after = Number(await line.getAttribute('aria-valuenow'));
  assert.ok(after < before, `${after} is less than ${before}`);
  assert.match(await text(page, '.answers'), /No map reaches it\. The closest/);
  await holds(page, 'budget', String(after));
  assert.equal(Number(await page.locator('#budget').inputValue()), after);
  assert.equal(await page.locator('.budget-line').nth(1).getAttribute('aria-valuenow'), String(after), 'the lines of both plots move');
  // From the keyboard, and as a number.
  await line.focus();
  await page.keyboard.press('End');
  await page.waitForFunction(() => /Fastest/.test(document.querySelector('.answers').innerText));
  assert.ok(Number(await line.getAttribute('aria-valuenow')) > after);
  await page.fill('#budget', '0.5');
  await page.keyboard.press('Enter');
  await holds(page, 'budget', '0.5');
};

looking['plots and tables are saved'] = async (given) => {
  const {page} = given;
  await open(given);
  const saved = async (act) => {
    const [download] = await Promise.all([page.waitForEvent('download'), act()]);
    return {name: download.suggestedFilename(), data: readFileSync(await download.path())};
  };
  const svg = await saved(() => page.click('.trade button:has-text("SVG") >> nth=0'));
  assert.equal(svg.name, 'small.speed.svg');
  assert.match(String(svg.data), /^<svg xmlns="http:\/\/www\.w3\.org\/2000\/svg"[^]*small: Speed against error[^]*lookup error, RMS[^]*allowed: [\d.]+[^]*<\/svg>$/);
  const png = await saved(() => page.click('.trade button:has-text("PNG") >> nth=1'));
  assert.equal(png.name, 'small.bytes.png');
  assert.deepEqual([...png.data.subarray(1, 4)], [...Buffer.from('PNG')]);
  assert.ok(png.data.readUInt32BE(16) > 600, 'two pixels of the picture for one of the screen');
  const csv = await saved(() => page.click('button[aria-label="Save the table as CSV"]'));
  const rows = String(csv.data).trim().split('\r\n');
  assert.match(rows[0], /^technique,build ms,image ns,image x floor,/);
  assert.equal(rows.length, 1 + await page.locator('.cells tbody tr').count());
  const functions = await saved(() => page.click('button[aria-label="Save the functions as CSV"]'));
  assert.match(String(functions.data), /^function,channel,depth,visibility\r\nexact,0,2,1\r\n/);
};

looking['the address holds what is shown'] = async (given) => {
  const {page, url, browser} = given;
  await open(given);
  const titles = () => text(page, '#cell-title');
  const first = await titles();
  await page.locator('.cell-name', {hasText: 'fourier'}).click();
  await page.waitForFunction(() => document.querySelector('#cell-title').textContent.includes('fourier'));
  await page.selectOption('.panel:has(#trade-title) select >> nth=0', 'curve.max');
  await page.selectOption('#compare select >> nth=1', 'shadow');
  await page.click('button[aria-label="Zoom in"]');
  await page.locator('img-comparison-slider').evaluate((slider) => { slider.value = 30; slider.dispatchEvent(new Event('slide')); });
  await page.fill('#curves input[aria-label="x"]', '5');
  await page.fill('#curves input[aria-label="y"]', '6');
  await page.click('#curves .pixel-entry button');
  await page.waitForFunction(() => document.querySelector('#curves .curve-title').textContent.includes('5, 6'));
  await page.click('button[aria-label="Show fewer depths"]');
  await page.waitForFunction(() => location.hash.includes('depth='));
  const state = await stateOf(page);
  assert.deepEqual([state.technique, state.error, state.picture, state.split, state.pixel], ['5', 'curve.max', 'shadow', '30', '5,6']);
  const seen = (where = page) => where.evaluate(() => ({
    cell: document.querySelector('#cell-title').textContent, error: document.querySelector('.trade .axis-title').textContent, title: document.querySelector('.curve-title').textContent,
    picture: document.querySelector('#compare img').alt, zoom: document.querySelector('#compare .frame-content').style.transform,
    split: Math.round(document.querySelector('img-comparison-slider').value), depth: document.querySelector('.depth output').textContent,
  }));
  await page.waitForFunction(() => document.querySelector('#curves .mark-line path'));
  const before = await seen();
  // A reload, and a colleague who gets the address as a link.
  const colleague = await openPage(browser, {allowed: url});
  await Promise.all([page.reload(), colleague.page.goto(page.url())]);
  for (const where of [page, colleague.page]) {
    await where.waitForFunction(() => document.querySelector('.curve-title')?.textContent.includes('5, 6'));
    await where.waitForSelector('.budget-line');
    assert.deepEqual(await seen(where), before);
  }
  await colleague.close();
  // Back undoes steps, one by one, to where it began.
  for (const [name, is] of [['pixel', undefined], ['picture', undefined], ['error', undefined], ['technique', undefined]]) {
    await page.goBack();
    assert.equal((await stateOf(page))[name], is, name);
  }
  await page.waitForFunction((title) => document.querySelector('#cell-title').innerText === title, first);
};

looking['an address that names nothing there'] = async (given) => {
  await open(given, '?technique=99&pixel=999,-4&variant=7&light=x&error=none&zoom=a,b,c&depth=9,1&budget=-3&split=&map=no');
  assert.equal(await given.page.locator('.problem:not(:empty)').count(), 0);
  assert.ok(Number(await given.page.locator('#budget').inputValue()) > 0);
  await given.page.waitForFunction(() => document.querySelector('.curve-title').textContent.includes('31, 0'));
};

looking['pictures: pixels, shadows alone, and all errors on one scale'] = async (given) => {
  const {page} = given;
  await open(given);
  await page.waitForFunction(() => [...document.querySelectorAll('#compare img')].every((image) => image.naturalWidth > 0));
  await page.click('#compare button:has-text("1 : 1")');
  const sizes = await page.locator('#compare .frame-content img').evaluateAll((all) => all.map((image) => [image.getBoundingClientRect().width * devicePixelRatio, image.naturalWidth]));
  assert.ok(sizes.every(([shown, own]) => Math.abs(shown - own) < 0.5), `a pixel of the picture is one of the screen: ${sizes}`);
  assert.equal(await text(page, '#compare output'), '1 : 1');
  await page.click('#compare button:has-text("Whole")');
  await holds(page, 'zoom', '');
  assert.deepEqual(await page.locator('#compare figcaption').allInnerTexts().then((all) => all.filter((t) => t.startsWith('the shadow alone')).length), 2);
  const errors = (await page.locator('.ranked small').allInnerTexts()).map((t) => Number(t.replace('RMS ', '')));
  assert.ok(errors.length >= 5);
  assert.deepEqual(errors, [...errors].sort((a, b) => a - b), 'from the least error');
  await page.locator('.ranked').last().click();
  await page.waitForFunction(() => document.querySelector('.ranked:last-child').getAttribute('aria-pressed') === 'true');
  assert.ok((await text(page, '#cell-title')).includes((await page.locator('.ranked span').last().innerText()).split(' ')[0]));
};

looking['the depth axis under the pointer'] = async (given) => {
  const {page, mock} = given;
  mock.results = JSON.parse(readFileSync(join(mock.fixture, 'result.json'), 'utf8'));
  Object.assign(mock.results.variants[0].lights[0].map, {z_min: 1, z_max: 4});  // as of the mock's functions
  await open(given);
  const depths = async () => (await text(page, '.depth output')).split(' to ').map(Number);
  const near = (found, wanted, words) => found.forEach((v, i) => assert.ok(Math.abs(v - wanted[i]) < 0.01 * size, `${words}: ${found}, not ${wanted}`));
  const frameOf = async (name) => {
    const frame = page.locator(`[aria-label^="${name}"] .role-frame.root > g > path.background`);
    await frame.scrollIntoViewIfNeeded();
    return frame.boundingBox();
  };
  const [low, high, size] = [1, 4, 3];
  assert.deepEqual(await depths(), [low, high]);
  // With Ctrl, the wheel zooms about the depth under the pointer, by e for 300 pixels. Alone, it scrolls the page.
  let box = await frameOf('Visibility against depth');
  await page.mouse.move(box.x + 0.25 * box.width, box.y + box.height / 2);
  await page.mouse.wheel(0, -300);
  near(await depths(), [low, high], 'the wheel alone');
  box = await frameOf('Visibility against depth');
  await page.mouse.move(box.x + 0.25 * box.width, box.y + box.height / 2);
  await page.keyboard.down('Control');
  await page.mouse.wheel(0, -300);
  await page.keyboard.up('Control');
  await page.waitForFunction((was) => document.querySelector('.depth output').textContent !== was, `${low} to ${high}`);
  const part = size / Math.E, from = low + 0.25 * (size - part);
  near(await depths(), [from, from + part], 'Ctrl and the wheel');
  // What is dragged follows the pointer, here on the strip of errors; both plots show the same depths.
  box = await frameOf('Stored minus exact');
  await page.mouse.move(box.x + 0.8 * box.width, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + box.height / 2, {steps: 4});
  await page.mouse.up();
  await page.mouse.move(box.x + 0.9 * box.width, box.y + box.height / 2);  // no longer held
  const moved = [from + 0.4 * part, from + 1.4 * part];
  near(await depths(), moved, 'dragging');
  await page.waitForFunction((to) => Math.abs(new URLSearchParams(location.hash.split('?')[1]).get('depth')?.split(',')[0] - to) < 0.02, moved[0]);
  for (const name of ['Visibility against depth', 'Stored minus exact']) {
    const ticks = (await page.locator(`[aria-label^="${name}"] .role-axis:has(.role-axis-label) >> nth=0`).locator('.role-axis-label text').allTextContents()).map(Number);
    assert.ok(ticks.length > 2 && ticks.every((v) => v >= moved[0] - 0.01 && v <= moved[1] + 0.01), `${name}: ${ticks}`);
  }
};

looking['functions: the worst pixel, depths and errors'] = async (given) => {
  const {page} = given;
  await open(given);
  const strip = page.locator('[aria-label^="Stored minus exact"]');
  await strip.locator('.mark-line path').first().waitFor();
  // Pointing is live and leaves the address; when the pointer goes, what was chosen is shown again.
  const chosen = await text(page, '.curve-title'), grid = page.locator('#curves .grid');
  await grid.scrollIntoViewIfNeeded();
  const box = await grid.boundingBox();
  await page.mouse.move(box.x + box.width * 0.2, box.y + box.height * 0.2);
  await page.waitForFunction((was) => document.querySelector('.curve-title').textContent !== was, chosen);
  assert.equal((await stateOf(page)).pixel, undefined);
  await page.mouse.move(box.x + box.width * 0.2, box.y - 80);
  await page.waitForFunction((was) => document.querySelector('.curve-title').textContent === was, chosen);
  await page.locator('#curves button[aria-label^="Show the worst pixel of shadow_map"]').click();
  await page.waitForFunction(() => new URLSearchParams(location.hash.split('?')[1]).get('pixel'));
  const [x, y] = (await stateOf(page)).pixel.split(',');
  await page.waitForFunction((at) => document.querySelector('.curve-title').textContent.endsWith(at), `${x}, ${y}`);
  // Fewer depths: both plots show the same.
  const tick = (name) => page.locator(`[aria-label^="${name}"] .role-axis-label text`).allTextContents();
  const whole = await text(page, '.depth output');
  await page.click('button[aria-label="Show fewer depths"]');
  await page.click('button[aria-label="Further depths"]');
  await page.waitForFunction((was) => document.querySelector('.depth output').textContent !== was, whole);
  await page.waitForFunction(() => location.hash.includes('depth='));
  assert.ok((await tick('Visibility against depth')).length > 2 && (await tick('Stored minus exact')).length > 2);
  await page.click('button[aria-label="Show all depths"]');
  await holds(page, 'depth', '');
  // Keys move from pixel to pixel in one step of the history.
  const steps = await page.evaluate(() => history.length);
  await grid.focus();
  for (const key of ['ArrowLeft', 'ArrowLeft', 'ArrowUp']) await page.keyboard.press(key);
  await page.waitForFunction((was) => new URLSearchParams(location.hash.split('?')[1]).get('pixel') !== was, `${x},${y}`);
  assert.equal(await page.evaluate(() => history.length), steps);
};
