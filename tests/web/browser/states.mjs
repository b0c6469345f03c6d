// What the page says when things are not as they should be; the server is a mock.
import assert from 'node:assert/strict';
import {assertAccessible, assertContrast, openPage, picture} from './harness.mjs';
import {firstPage} from './first.mjs';
import {keyboard} from './keyboard.mjs';
import {looking} from './looking.mjs';
import {ofPlots} from './plots.mjs';
import {ofResults} from './results.mjs';
import {makeFixture, startMock} from './server.mjs';

const text = (page, selector) => page.locator(selector).innerText();
const states = {...firstPage, ...keyboard, ...looking, ...ofPlots, ...ofResults};

states['no jobs'] = async ({page, url}) => {
  await page.goto(`${url}#/jobs`);
  await page.waitForSelector('.empty:not([hidden])');
  assert.match(await text(page, '.empty'), /There are no jobs yet/);
  assert.equal(await page.locator('table').isVisible(), false);
};

states['every state of a job'] = async ({page, url, mock}) => {
  mock.job('succeeded');
  mock.job('succeeded', {name: 'cached', cached: true});
  mock.jobs[0].promises_kept = false;
  mock.job('failed', {error: {code: 65, where: '/lights/0', message: 'sees nothing'}});
  mock.job('cancelled');
  const running = mock.job('running');
  mock.job('queued', {position: 0});
  mock.job('queued', {position: 3});
  await page.goto(`${url}#/jobs`);
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 7);
  const table = await text(page, '.jobs');
  for (const words of ['3 before it', 'next', '42 %: build, light key (1 of 2)', 'sees nothing', 'cancelled', 'promise broken', 'from an earlier result', '5.38 s'])
    assert.ok(table.includes(words), words);
  // It moves without a reload, and the row stays the same element.
  await page.locator('.jobs tbody tr').nth(2).evaluate((row) => { row.id = 'kept'; });
  mock.step(running);
  await page.waitForFunction(() => document.querySelector('#kept progress')?.value === 0.8);
  while (running.state !== 'succeeded') mock.step(running);
  await page.waitForFunction(() => document.querySelector('#kept').textContent.includes('succeeded'));
  assert.equal(await page.locator('#status').innerText(), 'small: succeeded');
};

states['cancel, retry and delete'] = async ({page, url, mock}) => {
  mock.job('running');
  await page.goto(`${url}#/jobs`);
  await page.waitForSelector('.jobs .state-running');
  assert.equal(await page.locator('.jobs button:has-text("Retry")').isVisible(), false);
  await page.click('.jobs button:has-text("Cancel")');
  await page.waitForSelector('.jobs .state-cancelled');
  await page.click('.jobs button:has-text("Retry")');
  await page.waitForSelector('.jobs .state-queued');
  await page.click('.jobs button:has-text("Cancel")');
  await page.waitForSelector('.jobs .state-cancelled');
  await page.click('.jobs button:has-text("Delete")');
  await page.waitForSelector('.empty:not([hidden])');
  assert.equal(mock.jobs.length, 0);
};

states['older jobs and a state'] = async ({page, url, mock}) => {
  for (let i = 0; i < 60; ++i) mock.job(i % 2 ? 'cancelled' : 'failed', {name: `job ${i}`});
  await page.goto(`${url}#/jobs`);
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 50);
  await page.click('button:has-text("Show older jobs")');
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 60);
  await page.selectOption('.page-head select', 'failed');
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 30);
};

states['jobs of others, found and pinned'] = async ({page, url, mock}) => {
  const kept = mock.job('succeeded', {name: 'hair', owner: 'alice', labels: ['nightly', '<b>bold</b>']});
  mock.job('failed', {owner: 'bob'});
  mock.job('failed', {owner: 'bob', labels: ['nightly']});
  await page.goto(`${url}#/jobs`);
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 3);
  const row = page.locator('.jobs tr', {hasText: 'alice'});
  assert.equal(await row.locator('.id').innerText(), `${kept.id}, alice, nightly, <b>bold</b>, 1.5 MiB`);
  await row.locator('button:has-text("Pin")').click();
  await row.locator('button:has-text("Unpin")').waitFor();
  assert.match(await row.locator('.id').innerText(), /, pinned$/);
  assert.ok(kept.pinned);
  await page.fill('input[type="search"]', 'nightly');
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 2);
  await page.selectOption('.page-head select', 'failed');
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 1);
  assert.match(page.url(), /#\/jobs\?text=nightly&state=failed$/);
  await page.reload();
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 1);
  assert.deepEqual([await page.locator('input[type="search"]').inputValue(), await page.locator('.page-head select').inputValue()], ['nightly', 'failed']);
  await page.goBack();
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 2);
  await page.click('nav a[href="#/jobs"]');
  await page.waitForFunction(() => document.querySelectorAll('.jobs tbody tr').length === 3);
};

states['a job that failed'] = async ({page, url, mock}) => {
  const job = mock.job('failed', {attempts: 3, error: {code: 65, where: '/lights/0', message: '<i>sees</i> nothing'}});
  await page.goto(`${url}#/jobs/${job.id}`);
  await page.waitForSelector('.fault');
  assert.match(await text(page, '.fault'), /\/lights\/0 <i>sees<\/i> nothing/);
  assert.match(await text(page, '.fault'), /3 attempts/);
  // It can be queued once more, and is followed.
  await page.click('.fault button:has-text("Retry")');
  await page.waitForSelector('.progress');
  mock.step(job);
  await page.waitForFunction(() => document.querySelector('.stage-text').textContent.includes('capture'));
  Object.assign(job, {state: 'failed', error: {code: 65, where: '/lights/0', message: 'again'}});
  for (const wake of mock.waiting) wake();
  await page.waitForSelector('.fault');
  assert.match(await text(page, '.fault'), /again/);
  await page.click('button:has-text("Edit and run again")');
  await page.waitForSelector('.verdict-box .good');
  assert.match(await page.locator('#scenario').inputValue(), /"quickstart"/);
};

states['a job in the queue is cancelled'] = async ({page, url, mock}) => {
  const job = mock.job('queued', {position: 2});
  await page.goto(`${url}#/jobs/${job.id}`);
  await page.waitForFunction(() => document.querySelector('.stage-text')?.textContent === 'Queued: 2 before it');
  await page.click('.progress button');
  await page.waitForFunction(() => document.querySelector('.ended')?.textContent.includes('The job was cancelled'));
  assert.equal(await page.locator('.fault').count(), 0, 'which is no alarm');
};

states['no such job'] = async ({page, url}) => {
  await page.goto(`${url}#/jobs/j-none`);
  await page.waitForFunction(() => document.querySelector('.problem').textContent === 'There is no job j-none, or it was deleted.');
  assert.equal(await text(page, 'h1'), 'No such job');
  await page.click('main a:has-text("All jobs")');
  await page.waitForSelector('.empty:not([hidden])');
  await page.goBack();
  await page.waitForFunction(() => document.querySelector('h1').textContent === 'No such job');
};

states['text that is not JSON'] = async ({page, url}) => {
  await page.goto(url);
  await page.waitForSelector('.verdict-box .good');
  await page.locator('#scenario').fill('{\n  "name": "x",\n  "lights": [1, 2,, 3]\n}');
  await page.waitForSelector('.faults');
  assert.equal(await text(page, '.numbers .bad'), '3');
  assert.match(await text(page, '.faults'), /line 3\s*Expected a value instead of ","/);
  await page.click('#run');  // says it again, and sends nothing
  assert.ok(await page.evaluate(() => document.activeElement.id === 'scenario'));
};

states['a fault inside a part that is missing'] = async ({page, url}) => {
  await page.goto(url);
  await page.waitForSelector('.verdict-box .good');
  await page.locator('#scenario').fill('{\n  "name": "x",\n  "rays": {"samples_per_pixel": 4}\n}');
  await page.waitForSelector('.faults');
  assert.match(await text(page, '.faults'), /line 1\s*\/techniques/);
};

states['a full queue'] = async ({page, url, mock}) => {
  mock.refuse = {status: 429, detail: 'The queue is full.', headers: {'Retry-After': '90'}};
  await page.goto(url);
  await page.waitForSelector('.verdict-box .good');
  await page.click('#run');
  await page.waitForFunction(() => document.querySelector('.submit .problem').textContent ===
    'Not accepted: The queue is full. Try again in 1 min 30 s.');
  // The same again is the same request; another text is another.
  mock.refuse = null;
  await page.click('#run');
  await page.waitForURL(/#\/jobs\/j-/);
  assert.equal(mock.keys.length, 2);
  assert.equal(mock.keys[0], mock.keys[1]);
  await page.click('nav a[href="#/"]');
  await page.waitForSelector('.verdict-box .good');
  await page.click('#run');
  await page.waitForURL(/#\/jobs\/j-/);
  assert.notEqual(mock.keys[2], mock.keys[1]);
};

states['options reach the server'] = async ({page, url, mock}) => {
  await page.goto(url);
  await page.waitForSelector('.verdict-box .good');
  const scenario = await page.locator('#scenario').inputValue();
  await page.locator('#scenario').fill(scenario.replace('"rays": {', '"rays": {"seed": 12345678901234567891, '));
  await page.waitForSelector('.verdict-box .good');
  await page.uncheck('#pictures');
  await page.selectOption('.choice:has-text("Known results") select', 'fresh');
  await page.click('#run');
  await page.waitForURL(/#\/jobs\/j-/);
  assert.deepEqual(mock.jobs[0].options, {cache: 'fresh', pictures: false});
  assert.match(mock.bodies[0], /"seed": 12345678901234567891,/, 'with all digits');
};

states['a server that requires a token'] = async ({page, url, mock}) => {
  mock.token = 'let me in';
  const job = mock.job('succeeded');
  await page.goto(`${url}#/jobs/${job.id}`);
  await page.waitForSelector('dialog');
  await page.fill('#token', 'wrong');
  await page.click('dialog button');
  await page.waitForFunction(() => document.querySelector('#token')?.value === '');
  await page.waitForSelector('dialog >> text=The server refused that token.');
  await assertContrast(page);
  await page.fill('#token', 'let me in');
  await page.click('dialog button');
  await page.waitForFunction(() => document.querySelectorAll('#cell .strip img').length === 4 &&
    [...document.querySelectorAll('#cell .strip img')].every((image) => image.src.startsWith('blob:') && image.naturalWidth > 0));
};

states['a server that is gone'] = async ({page, url, mock}) => {
  mock.job('succeeded');
  await page.goto(`${url}#/jobs`);
  await page.waitForSelector('.jobs tbody tr');
  mock.stop();
  await page.waitForFunction(() => document.querySelector('.problem').textContent.includes('does not answer'));
  assert.equal(await page.locator('.jobs tbody tr').count(), 1, 'what was known stays');
};

export default async function run(options) {
  const fixture = makeFixture(options);
  const expected = [/Failed to load resource/];  // the answers that are no success
  for (const [name, state] of Object.entries(states).filter(([name]) => name.includes(options.only ?? ''))) {
    const {mock, url, stop} = await startMock({...options, fixture});
    const {page, close} = await openPage(options.browser, {allowed: url, expected});
    try {
      await state({page, url, mock, browser: options.browser});
      for (const colorScheme of ['light', 'dark'])
        for (const width of [1440, 1024, 390]) {
          await page.emulateMedia({colorScheme});
          await page.setViewportSize({width, height: 900});
          // axe-core without contrast knows no colours, so the second scheme would take its time again for the same answers.
          await assertAccessible(page, {axe: colorScheme === 'light', focus: width !== 1024});
          await assertContrast(page);
          await picture(page, `state-${name.replaceAll(' ', '-')}-${colorScheme}-${width}`);
        }
      await close();
    } catch (error) {
      error.message = `${name}: ${error.message}`;
      throw error;
    } finally {
      await stop();
    }
  }
}
