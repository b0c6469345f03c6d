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
  await ready(page);
  assert.match(await page.locator('.verdict-box').innerText(), /7 settings of 6 techniques, about 4\.2\u00a0s/, 'as many techniques as boxes');
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
  // Beside the text too, where one is after bringing a file. Both places have one question, which the address holds.
  await page.goto(url);
  await ready(page);
  const asked = () => page.evaluate(() => ['.card:has(form)', '.submit'].map((place) => [...document.querySelectorAll(`${place} [aria-label="Error that is allowed"], ${place} .choice select`)]
    .filter((e) => e.matches('input') || e.parentElement.textContent.startsWith('within')).map((e) => e.value).join()));
  assert.deepEqual(await asked(), ['0.05,2', '0.05,2']);
  await page.selectOption('.actions .choice:has-text("within") select', '5');
  await page.fill('.common input[aria-label="Error that is allowed"]', '0.1');
  assert.deepEqual(await asked(), ['0.1,5', '0.1,5']);
  await page.selectOption('.card .choice:has-text("within") select', '15');
  await page.waitForFunction(() => /^#\/?\?within=15&error=0.1$/.test(location.hash));
  await page.goBack();
  await page.waitForFunction(() => document.querySelector('.actions .choice select').value === '5');
  await page.reload();
  await ready(page);
  assert.deepEqual(await asked(), ['0.1,5', '0.1,5'], 'a reload keeps it');
  await page.click('.actions button:has-text("Recommend for this error")');
  await page.waitForURL(/#\/jobs\/j-/);
  assert.deepEqual(mock.jobs[0].recommend, {error: 0.1, budget: 300});
  await page.goto(`${url}#/?error=7&within=3`);
  await ready(page);
  assert.deepEqual(await asked(), ['0.05,2', '0.05,2'], 'what nobody can ask for is not asked');
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

firstPage['a server without examples'] = async ({page, url, mock}) => {
  mock.scenarios = [];
  const card = (words) => page.locator('.card', {hasText: words});
  await page.goto(url);
  await page.waitForFunction(() => document.querySelector('.card').innerText.includes('This server lists no examples.'));
  assert.equal(await page.locator('button:has-text("Show the example")').count(), 0);
  // The file that is chosen is what a recommendation is asked for, and what is run.
  await card('Bring a file').locator('select').first().selectOption('smoke.vdb');
  await page.fill('.card input[aria-label="Error that is allowed"]', '0.02');
  await page.click('.card button:has-text("Recommend")');
  await page.waitForURL(/#\/jobs\/j-/);
  assert.deepEqual([mock.asked, mock.jobs[0].name, mock.jobs[0].recommend.error], [{files: ['smoke.vdb'], up: 'y'}, 'smoke.vdb', 0.02]);
  await page.goto(url);
  await card('Bring a file').locator('button').waitFor();
  await page.click('#run');
  await page.waitForURL(/#\/jobs\/j-/);
  assert.equal(mock.jobs[0].name, 'ponytail.hair');
  // Without a file, the words beside the button say what to do first.
  mock.dataFiles = [];
  await page.goto(url);
  await page.waitForFunction(() => document.body.innerText.includes('There are no such files'));
  await page.click('.card button:has-text("Recommend")');
  await page.waitForFunction(() => [...document.querySelectorAll('.card .problem')].some((e) => e.textContent.startsWith('There is no scenario yet')));
  await page.click('#run');
  await page.waitForFunction(() => document.querySelector('.submit > .problem').textContent.startsWith('There is no scenario yet'));
  assert.equal(mock.jobs.length, 2);
};
