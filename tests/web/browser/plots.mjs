// The plots of a result whose values are made by hand: what is drawn for intervals, fronts and settings, and what is chosen.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';

export const ofPlots = {};

// Of each cell of the fixture: lookup in ns with its interval, bytes, RMS with its interval, marks of both fronts.
const cells = [
  [10, [10, 10], 16384, 0.4, [0.4, 0.4], 'certainly', 'certainly'],     // shadow_map
  [40, [30, 60], 40000, 0.03, [0.025, 0.036], 'perhaps', 'perhaps'],    // deep
  [20, [18, 22], 32768, 0.05, [0.045, 0.055], 'certainly', 'certainly'],  // avsm nodes=4
  [25, [22, 28], 65536, 0.04, [0.035, 0.045], 'perhaps', 'no'],         // avsm nodes=8
  [50, [50, 50], 131072, 0.06, [0.06, 0.06], 'no', 'no'],               // fourier
  [600, [600, 600], 16384, 0.06, [0.06, 0.06], 'no', 'no'],             // uncompressed
];

function handMade(mock) {
  const result = JSON.parse(readFileSync(join(mock.fixture, 'result.json'), 'utf8'));
  result.variants[0].lights[0].cells.forEach((cell, i) => {
    const [ns, nsInterval, bytes, rms, interval, time, size] = cells[i];
    Object.assign(cell, {status: 'ok', verdict: 'kept', bytes, on_bytes_error_front: size, lookup_error: {...cell.lookup_error, rms, rms_interval95: interval}});
    Object.assign(cell.times, {on_time_error_front: time, lookup_random_order: {ns: {median: ns, interval95: nsInterval}}});
  });
  mock.results = result;
  return result.variants[0].lights[0].cells;
}

async function open({page, url, mock}, query) {
  await page.goto(`${url}#/jobs/${mock.job('succeeded').id}${query}`);
  await page.waitForSelector('.trade .mark-symbol path');
  await page.waitForSelector('#curves .curve-legend');
}

const marks = (plot, layer, what) => plot.locator(`.${layer}_marks ${what}`);

ofPlots['what has no map is never chosen first'] = async (given) => {
  const {page, mock} = given, all = handMade(mock);
  // Where it would be chosen: the first cell, the fastest, and the one that errs least. It has pictures too.
  all.unshift({...all[0], technique: 'ray_traced', label: '', parameters: {samples: 16}, where: '/techniques/9', bytes: 0, nodes: {cells: 0}, lookup_error: {...all[0].lookup_error, rms: 0.001, rms_interval95: [0.001, 0.001]},
    times: {...all[0].times, lookup_random_order: {ns: {median: 5, interval95: [5, 5]}}}});
  const images = JSON.parse(readFileSync(join(mock.fixture, 'images', 'images.json'), 'utf8'));
  images.techniques.unshift({...images.techniques[0], technique: 'ray_traced'});
  mock.files['images/images.json'] = images;
  await open(given, '?budget=0.1');
  assert.match(await page.locator('#cell-title').innerText(), /avsm nodes=4/, 'the fastest map within the error');
  assert.match(await page.locator('img-comparison-slider').getAttribute('aria-label'), /against avsm nodes=4/);
  assert.match(await page.locator('#compare select option:checked').first().innerText(), /avsm nodes=4/);
  assert.match(await page.locator('.answers').innerText(), /Without a map\s+ray_traced 5 ns/);
  const names = (plot) => marks(plot, 'points', 'path').evaluateAll((paths) => paths.map((path) => path.getAttribute('aria-label').split('\n')[0]));
  const [speed, bytes] = [page.locator('.trade').first(), page.locator('.trade').nth(1)];
  assert.equal((await names(speed)).filter((name) => name.includes('ray_traced')).length, 1);
  assert.equal((await names(bytes)).filter((name) => name.includes('ray_traced')).length, 0);
  assert.equal((await names(bytes)).length, 6);
  assert.match(await bytes.innerText(), /Not drawn: ray_traced \(1\) stores no map/);
  // Nor is it where no map could be built, and the first of them has no pictures.
  for (const cell of all.slice(1)) Object.assign(cell, {status: 'failed', reason: 'too large', verdict: 'failed'});
  images.techniques = images.techniques.filter((own) => own.technique !== 'shadow_map');
  await page.reload();
  await page.waitForSelector('#curves .curve-legend');
  assert.match(await page.locator('#cell-title').innerText(), /shadow_map/);
  assert.match(await page.locator('img-comparison-slider').getAttribute('aria-label'), /against deep/);
};

ofPlots['the smallest beside the fastest'] = async (given) => {
  const {page, mock} = given;
  handMade(mock);
  await open(given, '?budget=0.1');
  const rows = () => page.locator('.answers > div').allInnerTexts().then((all) => all.map((row) => row.replace(/\s+/g, ' ').trim()));
  assert.deepEqual(await rows(), ['Fastest avsm nodes=4 20 ns, 32 KiB, error 0.05 Perhaps as fast: avsm nodes=8.', 'Smallest uncompressed 600 ns, 16 KiB, error 0.06; 0.5 × the bytes, 30 × the time']);
  await page.fill('#budget', '0.037');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.querySelectorAll('.answers > div').length === 1);
  assert.deepEqual(await rows(), ['Fastest and smallest deep tolerance=0.01 40 ns, 39.1 KiB, error 0.03']);
};

ofPlots['a line joins the settings of a technique'] = async (given) => {
  const {page, mock} = given, all = handMade(mock);
  all.find((cell) => cell.label === 'nodes=8').label = '';  // as it is named where it is not swept
  await open(given, '');
  const labels = await marks(page.locator('.trade').first(), 'labels', 'text').allTextContents();
  for (const words of ['avsm nodes=4', 'avsm nodes=8']) assert.ok(labels.includes(words), `${words} in ${labels}`);
  assert.ok((await page.locator('.cell-name').allInnerTexts()).some((name) => name.includes('avsm nodes=8')), 'the table names it as well');
  for (const plot of [0, 1]) {
    const lines = marks(page.locator('.trade').nth(plot), 'lines', 'path');
    assert.equal(await lines.count(), 1, 'avsm has two settings, all others have one');
    // It ends at the middles of their marks.
    const ends = await lines.evaluate((path) => {
      const at = ({x, y}) => { const p = new DOMPoint(x, y).matrixTransform(path.getScreenCTM()); return [p.x, p.y]; };
      return [at(path.getPointAtLength(0)), at(path.getPointAtLength(path.getTotalLength()))];
    });
    for (const [i, words] of ['avsm nodes=4', 'avsm nodes=8'].entries()) {
      const box = await page.locator('.trade').nth(plot).locator(`.points_marks path[aria-label*="${words}"]`).boundingBox();
      assert.ok(Math.hypot(box.x + box.width / 2 - ends[i][0], box.y + box.height / 2 - ends[i][1]) < 3, `the line ends at ${words}`);
    }
  }
};

ofPlots['intervals, and what is not decided'] = async (given) => {
  const {page, mock} = given;
  handMade(mock);
  await open(given, '');
  const plot = page.locator('.trade').first();
  // Three cells have intervals of both: a bar has a length in one direction.
  const long = (layer) => marks(plot, layer, 'line').evaluateAll((all) => all.map((line) => line.getBoundingClientRect()).filter((box) => Math.max(box.width, box.height) > 2).map((box) => box.width > box.height));
  assert.deepEqual(await long('across'), [true, true, true]);
  assert.deepEqual(await long('upright'), [false, false, false]);
  // The steps of the front: shadow_map and avsm nodes=4 certainly, then two that are perhaps on it.
  const steps = await marks(plot, 'front', 'path').evaluateAll((all) => all.map((path) => ({x: path.getBoundingClientRect().x, dash: path.getAttribute('stroke-dasharray'), length: path.getTotalLength()})));
  assert.deepEqual(steps.sort((a, b) => a.x - b.x).map((step) => step.dash), ['1,0', '1,0', '5,4', '5,4']);
  assert.ok(steps.every((step) => step.length > 5));
  const fills = await marks(plot, 'points', 'path').evaluateAll((all) => Object.fromEntries(all.map((path) => [path.getAttribute('aria-label').split('\n')[0].slice(3), path.getAttribute('fill') === path.getAttribute('stroke')])));
  assert.deepEqual([fills.shadow_map, fills['deep tolerance=0.01'], fills['avsm nodes=4']], [true, false, true], 'open marks are perhaps on it');
  // The band lies where the front may be: from the good end of deep's interval to the bad end of all.
  const band = await marks(plot, 'band', 'path').evaluate((path) => ({width: path.getBBox().width, height: path.getBBox().height, fill: path.getAttribute('fill')}));
  assert.ok(band.width > 50 && band.height > 20, JSON.stringify(band));
  assert.equal(band.fill, await page.evaluate(() => getComputedStyle(document.documentElement).getPropertyValue('--grid').trim()));
  // Without intervals there are neither bars nor a band.
  for (const cell of mock.results.variants[0].lights[0].cells) {
    cell.times.lookup_random_order.ns.interval95 = null;
    cell.lookup_error.rms_interval95 = null;
  }
  await page.reload();
  await page.waitForSelector('.trade .mark-symbol path');
  assert.deepEqual([...await long('across'), ...await long('upright')], []);
  assert.equal(await marks(plot, 'band', 'path').count(), 0);
};
