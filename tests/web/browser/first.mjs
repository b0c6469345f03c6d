// The first page: what it says, its three things to do, and the form beside the text of a scenario.
import assert from 'node:assert/strict';

export const firstPage = {};
const scenarioOf = async (page) => JSON.parse(await page.locator('#scenario').inputValue());
const ready = (page) => page.waitForSelector('.verdict-box .good');

firstPage['the first page'] = async ({page, url}) => {
  await page.goto(url);
  await ready(page);
  assert.match(await page.locator('.lead').innerText(), /^shadowbench gives .*\. It measures .*\.$/, 'two sentences');
  await page.waitForFunction(() => document.querySelector('.hero img').naturalWidth === 600);
  assert.deepEqual(await page.locator('.card h2').allInnerTexts(), ['Compare techniques on an example', 'Bring a file', 'Ask for a recommendation']);
  await page.click('button:has-text("Show the example")');
  assert.ok(await page.evaluate(() => document.activeElement.id === 'run'), 'the next step has the focus');
  assert.equal((await scenarioOf(page)).name, 'quickstart');
};

firstPage['a form that writes the text'] = async ({page, url}) => {
  await page.goto(url);
  await ready(page);
  await page.waitForSelector('.boxes input[value="fourier"]');
  const before = await scenarioOf(page), field = (name) => page.locator(`.common .choice:has-text("${name}") >> css=input, select`);
  assert.deepEqual([await field('light from').inputValue(), await field('its height').inputValue()], ['37', '52']);
  await page.selectOption('.common .choice:has-text("pixels a side") select', '64');
  await field('its height').fill('90');
  await field('its height').press('Tab');
  await page.check('.boxes input[value="fourier"]');
  await page.uncheck('.boxes input[value="deep"]');
  const after = await scenarioOf(page);
  assert.equal(after.rays.resolution, 64);
  assert.equal(after.rays.samples_per_pixel, before.rays.samples_per_pixel);
  assert.deepEqual(after.techniques.map((t) => t.type), ['shadow_map', 'pcf', 'avsm', 'uncompressed', 'ray_traced', 'fourier']);
  const [{position, target}] = after.lights, above = position.map((v, i) => v - target[i]);
  assert.ok(Math.abs(above[0]) < 1e-3 && Math.abs(above[2]) < 1e-3, 'the light stands above');
  assert.ok(Math.abs(above[1] - Math.hypot(...before.lights[0].position.map((v, i) => v - before.lights[0].target[i]))) < 1e-3, 'as far away as before');
  assert.equal(await page.locator('#example select, .page-head select').inputValue(), '', 'the text is not the example any more');
  // Text that a form would change in other places as well stays with its author.
  await page.locator('#scenario').fill('{"name": "x", "rays": {"seed": 12345678901234567891, "resolution": 64}}');
  await page.waitForSelector('.common:disabled');
  assert.match(await page.locator('.common').innerText(), /more digits than a form keeps/);
};

firstPage['a recommendation is asked for'] = async ({page, url, mock}) => {
  await page.goto(url);
  await ready(page);
  await page.fill('.card input[aria-label="Error that is allowed"]', '0.015');
  await page.click('.card button:has-text("Recommend")');
  await page.waitForURL(/#\/jobs\/j-/);
  assert.deepEqual(mock.jobs[0].recommend, {error: 0.015, budget: 120});
  // Beside the text too, where one is after bringing a file.
  await page.goto(url);
  await ready(page);
  await page.selectOption('.card:has-text("Ask for") select', '5');
  await page.fill('.common input[aria-label="Error that is allowed"]', '0.1');
  await page.click('.actions button:has-text("Recommend for this error")');
  await page.waitForURL(/#\/jobs\/j-/);
  assert.deepEqual(mock.jobs[0].recommend, {error: 0.1, budget: 300});
  // In a run, it is the error that is allowed at first.
  await page.goto(url);
  await ready(page);
  await page.fill('.common input[aria-label="Error that is allowed"]', '0.3');
  assert.equal(await page.locator('.card input[aria-label="Error that is allowed"]').inputValue(), '0.3');
  await page.click('#run');
  await page.waitForURL(/#\/jobs\/j-[^?]*\?budget=0\.3$/);
  await page.waitForSelector('.progress');
};

firstPage['a file of the data folders'] = async ({page, url, mock}) => {
  mock.dataFiles.push({name: 'torn.bad', bytes: 3});
  await page.goto(url);
  await ready(page);
  const card = page.locator('.card', {hasText: 'Bring a file'});
  assert.match(await card.innerText(), /more files than this list holds/);
  await card.locator('select').first().selectOption('torn.bad');
  await card.locator('button').click();
  await page.waitForFunction(() => document.querySelector('.card [role="alert"]').textContent === 'torn.bad: not a grid');
  await card.locator('select').first().selectOption('smoke.vdb');
  await card.locator('select').nth(1).selectOption('z');
  await card.locator('button').click();
  await page.waitForFunction(() => document.querySelector('#scenario').value.includes('"name": "smoke.vdb"'));
  assert.deepEqual(mock.asked, {files: ['smoke.vdb'], up: 'z'});
  assert.ok(await page.evaluate(() => document.activeElement.id === 'run'), 'the next step has the focus');
  // A scenario of one's own.
  await card.locator('input[type="file"]').setInputFiles({name: 'mine.json', mimeType: 'application/json', buffer: Buffer.from('{"name": "mine"}')});
  await page.waitForFunction(() => document.querySelector('#scenario').value === '{"name": "mine"}');
};

firstPage['the keyboard alone, from the first page to an answer'] = async ({page, url, mock}) => {
  await page.goto(url);
  await ready(page);
  // Goes on to the next element that the words name.
  const next = async (words) => {
    for (let i = 0; i < 60; ++i) {
      await page.keyboard.press('Tab');
      if (await page.evaluate((w) => (document.activeElement.getAttribute('aria-label') ?? document.activeElement.textContent).includes(w), words)) return;
    }
    assert.fail(`no Tab leads to ${words}`);
  };
  await next('Skip to the content');
  await page.keyboard.press('Enter');
  assert.ok(await page.evaluate(() => document.activeElement.id === 'main'), 'the address stays that of the page');
  assert.equal(await page.locator('#scenario').count(), 1);
  await next('Show the example');
  await page.keyboard.press('Enter');
  await ready(page);
  await page.keyboard.press('Enter');  // the button that runs it has the focus
  await page.waitForURL(/#\/jobs\/j-/);
  for (const [job] = mock.jobs; job.state !== 'succeeded';) mock.step(job);
  await page.waitForSelector('.answers button');
  await next('Error that is allowed');
  const before = await page.locator('.answers').innerText();
  await page.keyboard.press('Home');
  await page.waitForFunction((was) => document.querySelector('.answers').innerText !== was, before);
  await next('fourier');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.querySelector('#cell-title').textContent.includes('fourier'));
  await next('Map of light');
  const was = await page.locator('.curve-title').innerText();
  await page.keyboard.press('ArrowLeft');
  await page.waitForFunction((text) => document.querySelector('.curve-title').innerText !== text, was);
};
