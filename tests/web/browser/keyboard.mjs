// From the keyboard alone: to an answer, from a file to a recommendation, through jobs, to results side by side.
import assert from 'node:assert/strict';

export const keyboard = {};
const ready = (page) => page.waitForSelector('.verdict-box .good');

// Goes on to the next element whose name fits.
async function next(page, words) {
  for (let i = 0; i < 80; ++i) {
    await page.keyboard.press('Tab');
    const name = await page.evaluate(() => {
      const e = document.activeElement;
      return (e.getAttribute('aria-label') ?? ([...e.labels ?? []].map((label) => label.textContent).join(' ') || e.textContent)).trim();
    });
    if (words.test(name)) return;
  }
  assert.fail(`no Tab leads to ${words}`);
}

keyboard['the keyboard alone, from the first page to an answer'] = async ({page, url, mock}) => {
  await page.goto(url);
  await ready(page);
  await next(page, /^Skip to the content/);
  await page.keyboard.press('Enter');
  assert.ok(await page.evaluate(() => document.activeElement.id === 'main'), 'the address stays that of the page');
  assert.equal(await page.locator('#scenario').count(), 1);
  await next(page, /^Show the example/);
  await page.keyboard.press('Enter');
  await ready(page);
  await page.keyboard.press('Enter');  // the button that runs it has the focus
  await page.waitForURL(/#\/jobs\/j-/);
  for (const [job] = mock.jobs; job.state !== 'succeeded';) mock.step(job);
  await page.waitForSelector('.answers button');
  await next(page, /^Error that is allowed/);
  const before = await page.locator('.answers').innerText();
  await page.keyboard.press('Home');
  await page.waitForFunction((was) => document.querySelector('.answers').innerText !== was, before);
  await next(page, /fourier/);
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.querySelector('#cell-title').textContent.includes('fourier'));
  await next(page, /^Map of light/);
  const was = await page.locator('.curve-title').innerText();
  await page.keyboard.press('ArrowLeft');
  await page.waitForFunction((text) => document.querySelector('.curve-title').innerText !== text, was);
};

keyboard['the keyboard alone, from a file to a recommendation'] = async ({page, url, mock}) => {
  await page.goto(url);
  await ready(page);
  await next(page, /^File/);
  await page.keyboard.press('ArrowDown');
  await next(page, /^Up/);
  await page.keyboard.press('ArrowDown');
  await next(page, /^Make a scenario/);
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.querySelector('#scenario').value.includes('"name": "smoke.vdb"'));
  assert.deepEqual(mock.asked, {files: ['smoke.vdb'], up: 'z'});
  await next(page, /^within/);
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('Shift+Tab');
  await page.keyboard.press('Enter');
  await page.waitForURL(/#\/jobs\/j-/);
  assert.deepEqual([mock.jobs[0].name, mock.jobs[0].recommend], ['smoke.vdb', {error: 0.05, budget: 300}]);
};

keyboard['the keyboard alone, a job is cancelled and deleted'] = async ({page, url, mock}) => {
  mock.job('running');
  await page.goto(`${url}#/jobs`);
  await page.waitForSelector('.jobs .state-running');
  await next(page, /^Cancel small/);
  await page.keyboard.press('Enter');
  await page.waitForSelector('.jobs .state-cancelled');
  assert.match(await page.evaluate(() => document.activeElement.ariaLabel), /^Delete small/, 'the focus stays');
  await page.keyboard.press('Enter');
  await page.waitForSelector('.empty:not([hidden])');
  assert.equal(mock.jobs.length, 0);
};

keyboard['the keyboard alone, two results compared and explored'] = async ({page, url, mock}) => {
  const ids = [mock.job('succeeded'), mock.job('succeeded')].map((job) => job.id);
  await page.goto(`${url}#/compare`);
  await page.waitForSelector('.side select');
  await next(page, /^Job…/);
  await page.keyboard.press('ArrowDown');
  await next(page, /^Job…/);
  await page.keyboard.press('End');
  await page.waitForSelector('.outcome');
  assert.deepEqual(mock.compared, {baseline: {job: ids[1]}, current: {job: ids[0]}});
  await page.goto(`${url}#/explore`);
  await page.waitForSelector('.boxes input');
  for (const _ of ids) {
    await next(page, /^small, /);
    await page.keyboard.press('Space');
  }
  await page.waitForSelector('.trend .mark-symbol path');
  await next(page, /^Measure/);
  const before = await page.locator('.trend .plot').first().getAttribute('aria-label');
  await page.keyboard.press('ArrowDown');
  await page.waitForFunction((was) => document.querySelector('.trend .plot').getAttribute('aria-label') !== was, before);
};
