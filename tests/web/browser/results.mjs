// Pages of results: recommendations, pictures that are missing, results side by side.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';

export const ofResults = {};
const text = (page, selector) => page.locator(selector).innerText();

ofResults['a recommendation'] = async ({page, url, mock}) => {
  const job = mock.job('succeeded');
  Object.assign(job, {kind: 'recommendation', recommend: {error: 0.02}, promises_kept: null, reached: false,
    artifacts: ['result.json', 'result.csv', 'table.txt']});
  mock.files['table.txt'] = 'rms error at most 0.02 with 95 % confidence';
  const result = JSON.parse(readFileSync(join(mock.fixture, 'result.json'), 'utf8'));
  const axes = [{name: 'resolution', values: ['32', '64'], stride: 1}, {name: 'samples_per_pixel', values: ['4'], stride: 1}];
  const at = (family, step, error, ns, size) => ({family, step: [step, 0], failed: '', error, lookup_ns: ns, bytes: size, build_ms: 2});
  const sample = (v) => ({median: v, interval95: [0.9 * v, 1.1 * v]});
  result.recommendation = {light: 'key', measure: 'rms', goal: {error: 0.02, cheapest: ['bytes'], at_most: {}, budget_seconds: 9}, end: 'complete', steal: null, scout: null,
    families: [{technique: 'deep', name: 'deep', axes, mapless: false}, {technique: 'ray_traced', name: 'ray_traced', axes, mapless: true}],
    measured: [at(0, 0, 0.05, 10, 1000), at(0, 1, 0.019, 20, 4000), at(1, 0, 0.01, 900, 0)],
    confirmed: [{family: 0, step: [0, 0], failed: '', cut: false, error: {mean: 0.05, interval95: [0.049, 0.052]}, lookup_ns: sample(10), bytes: sample(1000), build_ms: sample(2)},
      {family: 0, step: [1, 0], failed: '', cut: false, error: {mean: 0.019, interval95: [0.018, 0.02]}, lookup_ns: sample(20), bytes: sample(4000), build_ms: sample(2)}]};
  mock.results = result;
  await page.goto(`${url}#/jobs`);
  await page.waitForSelector('.jobs tbody tr');
  for (const words of ['recommendation', 'error not reached']) assert.ok((await text(page, '.jobs')).includes(words), words);
  await page.goto(`${url}#/jobs/${job.id}`);
  await page.waitForSelector('.cells tbody tr');
  assert.equal(await text(page, 'pre.answer'), 'rms error at most 0.02 with 95 % confidence');
  const marks = page.locator('#explored .mark-symbol path');
  await marks.first().waitFor();
  assert.equal(await marks.count(), 3);
  assert.deepEqual(await page.locator('#explored .labels_marks text').allTextContents(), ['deep resolution=32', 'deep resolution=64', 'ray_traced'], 'labels name what differs');
  assert.match(await text(page, '#explored .levels'), /the error asked for: 0\.02\s+deep\s+ray_traced/);
  assert.match(await marks.nth(1).getAttribute('aria-label'), /deep, resolution=64\s+one lookup: 20 ns\s+error: 0\.019, 95 %: 0\.018 to 0\.02/);
  await page.selectOption('#explored select', 'bytes');
  await page.waitForFunction(() => document.querySelectorAll('#explored .mark-symbol path').length === 2);
  await page.goBack();
  await page.waitForFunction(() => document.querySelectorAll('#explored .mark-symbol path').length === 3);
  assert.equal(await page.locator('#curves').count(), 0, 'its points are not those of the scenario');
};

ofResults['the answer of a recommendation, and on from there'] = async ({page, url, mock}) => {
  const job = mock.job('succeeded');
  Object.assign(job, {kind: 'recommendation', recommend: {error: 0.02, budget: 300}, promises_kept: null, reached: true, artifacts: ['result.json', 'table.txt']});
  mock.files['table.txt'] = 'as the program prints it';
  const result = JSON.parse(readFileSync(join(mock.fixture, 'result.json'), 'utf8'));
  const choice = (technique, setting, ns, size, confirmed = true) => ({technique, setting, confirmed, error: [0.0181, 0.0195], lookup_ns: ns, bytes: size, build_ms: 76.2,
    part: {rays: {resolution: 91}, techniques: [{type: technique}]}});
  const family = (technique) => ({technique, name: technique, axes: [], mapless: technique === 'ray_traced'});
  result.recommendation = {light: 'key', measure: 'rms', goal: {error: 0.02, cheapest: ['bytes'], at_most: {}, budget_seconds: 9}, end: 'budget',
    families: [...['deep', 'avsm', 'ray_traced'].map(family), {...family('deep'), name: 'deep tolerance=0.1', axes: [{name: 'resolution', values: ['32', '59']}]}, {...family('avsm'), name: 'avsm', axes: [{name: 'resolution', values: ['']}, {name: 'samples', values: ['']}, {name: 'nodes', values: ['2', '4']}]}],
    measured: [], confirmed: [[3, [1], 44, 48], [4, [0, 0, 1], 40, 50]].map(([of, step, low, high]) => ({family: of, step, failed: '', bytes: {median: 45, interval95: [1024 * low, 1024 * high]}})), answer: {reached: true, without_map: choice('ray_traced', 'ray_traced samples=13', 8730, 0), closest: null,
      cheapest: [
        {cost: 'lookup_ns', ...choice('deep', 'deep kernel=tent, resolution=91', 6.56, 431104), runner_up: {...choice('avsm', 'avsm nodes=16, resolution=117', 23.3, 9, false), behind: 2.55, tie: false}, perhaps: null},
        {cost: 'bytes', ...choice('deep', 'deep tolerance=0.1, resolution=59', 60.5, 46182), runner_up: {...choice('avsm', 'avsm nodes=4', 9, 46182), behind: 0, tie: true}, perhaps: choice('avsm', 'avsm nodes=2', 3, 1024)}],
      missed: [{technique: 'shadow_map', why: 'already dearer', error: 0.928}, {technique: 'pcf', why: 'already dearer', error: 0.0942}, {technique: 'variance', why: 'the budget ended', error: null}],
      broken: [{technique: 'fourier', settings: 1, measured: 2, reason: '<b>rises</b>'}]}};
  mock.results = result;
  await page.goto(`${url}#/jobs/${job.id}`);
  await page.waitForSelector('.cells tbody tr');
  const first = page.locator('main .panel').first(), rows = await first.locator('.answers > div').allInnerTexts();
  assert.match(await first.innerText(), /With an error of at most 0\.02\s+\(RMS, 95 % confidence\)[^]*The time given ended first/);
  assert.match(rows[0], /Fastest lookup\s+deep kernel=tent, resolution=91 6\.56 ns a lookup, 421 KiB, 76\.2 ms to build, error 0\.0181 to 0\.0195\s+3\.5 × as much: avsm nodes=16, resolution=117, 23\.3 ns \(not confirmed\)/);
  assert.match(rows[1], /Fewest bytes\s+deep tolerance=0\.1, resolution=59 45\.1 KiB, [^]*A tie with avsm nodes=4, 45\.1 KiB \(95 %: 40 KiB to 50 KiB; of the best 44 KiB to 48 KiB\)\s*Perhaps 1 KiB, error not confirmed: avsm nodes=2/);
  assert.match(rows[2], /Without a map\s+ray_traced samples=13 8\.73 µs a lookup, error/);
  assert.match(await text(page, '#explored'), /No setting was measured/, 'no plot of nothing');
  assert.match(await page.locator('main .note').first().innerText(), /^recommendation, error at most 0\.02, within 5 min 0 s/);
  const second = page.locator('.panel.answer').nth(1);
  assert.match(await second.locator('h2').innerText(), /^Among the settings measured, with an error of at most/);
  assert.equal(await second.locator('#budget').inputValue(), '0.02', 'the error that was asked for');
  await first.locator('summary').first().click();
  assert.match(await first.locator('.facts').innerText(), /shadow_map\s+does not reach it\s+pcf\s+already dearer; closest error 0\.0942\s+variance\s+the budget ended; not measured\s+fourier\s+broke a promise at 1 of 2 settings; <b>rises<\/b>/);
  await first.locator('summary').nth(1).click();
  assert.match(await text(page, 'pre.answer'), /as the program prints it/);
  // On from there: the scenario with these settings, ready to run.
  await first.locator('button').first().click();
  await page.waitForSelector('.verdict-box .good');
  const scenario = JSON.parse(await page.locator('#scenario').inputValue());
  assert.deepEqual([scenario.rays.resolution, scenario.techniques], [91, [{type: 'deep'}, {type: 'avsm'}]], 'the runner-up beside it');
  assert.match(page.url(), /#\/\?error=0\.02&within=5$/, 'what was asked for goes along');
  assert.equal(await page.locator('.common input[aria-label="Error that is allowed"]').inputValue(), '0.02');
  await page.goBack();
  await page.waitForSelector('.cells tbody tr');
  for (const summary of await first.locator('summary').all()) await summary.click();
};

ofResults['a recommendation whose time was too short'] = async ({page, url, mock}) => {
  const job = mock.job('succeeded');
  Object.assign(job, {kind: 'recommendation', recommend: {error: 0.02, budget: 120, only: ['deep']}, promises_kept: null, reached: true, artifacts: ['result.json']});
  const result = JSON.parse(readFileSync(join(mock.fixture, 'result.json'), 'utf8'));
  const names = ['deep', 'avsm', 'pcf', 'variance'];
  result.recommendation = {light: 'key', measure: 'rms', goal: {error: 0.02, cheapest: [], at_most: {}, budget_seconds: 120}, end: 'budget', measured: [], confirmed: [],
    families: names.map((technique) => ({technique, name: technique, axes: [], mapless: false})),
    answer: {reached: true, too_early: {budget_seconds: 120, techniques: 4, open: 3, give_seconds: 300}, without_map: null, closest: null, broken: [], cheapest: [],
      missed: names.slice(1).map((technique) => ({technique, why: 'the budget ended', error: null}))}};
  mock.results = result;
  await page.goto(`${url}#/jobs/${job.id}`);
  await page.waitForSelector('.cells tbody tr');
  const said = /The time was too short\. 2 min 0 s ended before 3 of 4 techniques were followed to the error/, panel = page.locator('main .panel').first();
  assert.match(await panel.innerText(), said);
  delete result.recommendation.answer.too_early;  // as earlier versions wrote it
  await page.reload();
  await page.waitForSelector('.cells tbody tr');
  assert.match(await panel.innerText(), said);
  await page.click('button:has-text("Ask again with 5 min")');
  await page.waitForFunction(() => document.querySelector('.stage-text')?.textContent === 'Queued: next');
  assert.deepEqual(mock.jobs[0].recommend, {error: 0.02, budget: 300, only: ['deep']});
  assert.equal(mock.jobs[0].scenario.name, 'quickstart');
  assert.equal(await page.locator('.progress progress').isVisible(), false, 'no empty bar');
  await page.goBack();
  await page.waitForSelector('.cells tbody tr');
};

ofResults['pictures that could not be made'] = async ({page, url, mock}) => {
  const job = mock.job('succeeded');
  job.artifacts = ['result.json', 'images/error.json'];
  mock.files['images/error.json'] = {error: {code: 65, where: '/receivers', message: 'the camera sees no <b>surface</b>'}};
  await page.goto(`${url}#/jobs/${job.id}`);
  await page.waitForSelector('#curves .curve-legend');
  assert.match(await text(page, 'main'), /Pictures could not be made: \/receivers: the camera sees no <b>surface<\/b>\./);
};

ofResults['legends of the scale that was stored'] = async ({page, url, mock}) => {
  const job = mock.job('succeeded');
  const images = JSON.parse(readFileSync(join(mock.fixture, 'images', 'images.json'), 'utf8'));
  mock.files['images/images.json'] = {...images, heat_top: 0.02, difference_factor: 8};
  await page.goto(`${url}#/jobs/${job.id}`);
  await page.waitForSelector('#compare .ramp-heat');
  const legends = () => page.locator('.legend').evaluateAll((all) => all.map((e) => e.innerText.split(/\n+/).join(' ')));
  const heat = '0 0.01 ≥ 0.02 |visibility − reference|, mean of the channels; 1 is all of the light', through = '0 0.5 1 share of the light that gets past all that casts shadows';
  const difference = '0 0.0625 ≥ 0.125 |radiance − reference| a channel; 1 is white';
  assert.deepEqual(await legends(), [difference, heat, heat, heat, through]);
  assert.match(await text(page, '#cell .strip'), /Difference to the reference, × 8/);
  await page.selectOption('#compare select >> nth=2', 'difference');
  assert.deepEqual(await legends(), [difference, heat, difference, heat, through]);
};

ofResults['two results that differ'] = async ({page, url, mock}) => {
  const [a, b] = [mock.job('succeeded'), mock.job('succeeded', {name: 'other'})];
  await page.goto(`${url}#/jobs`);
  await page.click('.page-head a:has-text("Compare two results")');
  await page.waitForFunction(() => document.querySelector('main').textContent.includes('Choose two results'));
  await page.locator('.side select').nth(0).selectOption(a.id);
  await page.locator('.side select').nth(1).selectOption(b.id);
  await page.waitForSelector('.outcome.bad-title');
  assert.deepEqual(mock.compared, {baseline: {job: a.id}, current: {job: b.id}});
  assert.ok(page.url().endsWith(`#/compare/${a.id}/${b.id}`), 'the address names them');
  const table = await text(page, '.lines');
  for (const words of ['✕ less accurate', '✕ larger', '+8400 (+21 %)', '<b>not</b> in the current side', '× 1.22, 95 %: 1.17 to 1.29', '✓ smaller', '△ not comparable']) assert.ok(table.includes(words), words);
  assert.equal(await page.locator('.lines .verdict-less_accurate').evaluate((mark) => getComputedStyle(mark).color === getComputedStyle(document.querySelector('.outcome')).color), true, 'in the colour of what is bad');
  assert.doesNotMatch(table, /inconclusive/);
  await page.click('nav a[href="#/compare"]');
  await page.waitForFunction(() => document.querySelector('main').textContent.includes('Choose two results'));
  await page.goBack();
  await page.waitForSelector('.outcome.bad-title');
  assert.match(await text(page, '.fronts'), /avsm nodes=4 left the front/);
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('button[aria-label="Save the verdicts as CSV"]')]);
  const rows = readFileSync(await download.path(), 'utf8').split('\r\n');
  assert.equal(rows[1], 'small / key / avsm nodes=4,lookup_error.rms,less accurate,0.0721,0.0854,,+0.0133 (+18.4 %)');
};

ofResults['several results in one plot, and over time'] = async ({page, url, mock}) => {
  const jobs = [mock.job('succeeded'), mock.job('succeeded'), mock.job('succeeded', {kind: 'recommendation'})];
  // The later of the two jobs has the earlier run, of another commit.
  const result = JSON.parse(readFileSync(join(mock.fixture, 'result.json'), 'utf8'));
  const of = (commit, started) => ({...result, program: {...result.program, commit}, times: {...result.times, started}});
  mock.resultOf.set(jobs[0].id, of('bbbbbbbbb222', '2026-11-26T08:00:00Z')).set(jobs[1].id, of('aaaaaaaaa111', '2026-11-25T08:00:00Z'));
  await page.goto(`${url}#/explore`);
  await page.waitForSelector('.boxes input');
  assert.equal(await page.locator('.boxes input').count(), 2, 'a recommendation has points of its own');
  assert.match(await text(page, '.empty'), /Choose results/);
  for (const box of [0, 1]) await page.locator('.boxes input').nth(box).check();
  await page.waitForSelector('.trend .mark-symbol path');
  assert.match(decodeURIComponent(page.url()), new RegExp(`jobs=${jobs[1].id},${jobs[0].id}$`));
  const listed = await page.locator('.results li').allInnerTexts();
  assert.match(listed[0], /^#1 small 25 Nov 2026[^]*\(aaaaaaaaa\)$/);
  assert.match(listed[1], /^#2 small 26 Nov 2026[^]*\(bbbbbbbbb\)$/);
  const tips = await page.locator('.trend').first().locator('.mark-symbol path').evaluateAll((all) => all.map((mark) => mark.getAttribute('aria-label')));
  assert.deepEqual(tips.map((tip) => tip.split('\n').at(-1)), ['aaaaaaaaa', 'bbbbbbbbb'], 'a point says of which commit it is');
  const labels = await page.locator('.panel:has(#overlay-title) .labels_marks text').allTextContents();
  const names = labels.filter((label) => label && !/^#\d$/.test(label));
  assert.ok(names.length > 0 && new Set(names).size === names.length, `no two are labelled alike: ${names}`);
  const cells = 2 * 2 * 6, drawn = await page.locator('.panel:has(#overlay-title) .mark-symbol path').count();
  assert.equal(drawn, 2 * cells, 'the cells of both');
  assert.equal(await page.locator('.trend').count(), cells, 'each over time');
  await page.focus('.panel:has(#time-title) select');
  await page.selectOption('.panel:has(#time-title) select', 'bytes');
  await page.waitForFunction(() => document.querySelector('.trend .plot').getAttribute('aria-label').includes('bytes of the map'));
  assert.ok(await page.evaluate(() => document.activeElement.matches('[data-part="over"] select')), 'the focus stays');
  // A job that was removed does not hide the others.
  await page.goto(page.url().replace('jobs=', 'jobs=j-gone,'));
  await page.reload();
  await page.waitForFunction(() => document.querySelector('.trend .plot')?.getAttribute('aria-label').includes('bytes of the map'));
  assert.equal(await text(page, '.problem'), 'j-gone: There is no such job.');
};

ofResults['a file that is not a result'] = async ({page, url, mock}) => {
  const job = mock.job('succeeded');
  await page.goto(`${url}#/compare/${job.id}`);
  await page.waitForSelector('.side select');
  // Dropped, with all its digits.
  await page.locator('.side').nth(1).evaluate((side) => {
    const data = new DataTransfer();
    data.items.add(new File(['{"seed": 12345678901234567891}'], 'mine.json'));
    side.dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));
  });
  await page.waitForFunction(() => document.querySelector('.problem').textContent === 'Current: mine.json: not a result of run.');
  assert.equal(mock.comparedText, `{"baseline": {"job":"${job.id}"}, "current": {"result": {"seed": 12345678901234567891}}}`);
};
