// What the page reckons of results without a browser: fronts, answers, names, commands.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {answersAt, firstBudget} from '../../../service/web/page/result/answers.js';
import {around, differenceOf, thinned} from '../../../service/web/page/result/functions.js';
import {named} from '../../../service/web/page/result/names.js';
import {labelsOf, ownFronts, pointsAt, settingsOf} from '../../../service/web/page/result/settings.js';
import {overTime, pointsOfAll} from '../../../service/web/page/result/several.js';
import {linesOf, undecided} from '../../../service/web/page/result/points.js';
import {errors, fewestInterval, frontOf, fronts, lightMapOf, marked, originOf, quoted, rerunOf, rmsInterval, speeds, unsettledOf, seriesOf, worstPixelOf} from '../../../service/web/page/result/model.js';

test('a group whose floors drifted says why, and no other does', () => {
  const result = {times: {settled: false, unsettled: [{variant: 1, light: 'key', why: '3 of 14 floors spread'}]}};
  const group = (variant, light) => ({variant, light: {light}});
  assert.equal(unsettledOf(result, group(1, 'key')), '3 of 14 floors spread');
  assert.equal(unsettledOf(result, group(0, 'key')), null);
  assert.equal(unsettledOf(result, group(1, 'fill')), null);
  assert.equal(unsettledOf({times: {started: ''}}, group(1, 'key')), null, 'older results do not tell');
});

test('a group of a merged result names where it was measured, and no other does', () => {
  const cells = [{variant: 0, light: 1, node: 'n1'}, {variant: 1, light: 0, node: 'n2'}];
  assert.equal(originOf({times: {cells}}, {variant: 1, lightIndex: 0}).node, 'n2');
  assert.equal(originOf({times: {cells}}, {variant: 1, lightIndex: 1}), null);
  assert.equal(originOf({times: {started: ''}}, {variant: 0, lightIndex: 0}), null);
});

test('a time whose interval is wider than the goal is marked', () => {
  const cell = {times: {settled: {build: true, lookup_image_order: false, lookup_random_order: null}}};
  assert.equal(marked(cell, 'build', '1.5'), '1.5');
  assert.equal(marked(cell, 'lookup_image_order', '1.5'), '~1.5');
  assert.equal(marked(cell, 'lookup_random_order', '1.5'), '1.5', 'too few repetitions to judge');
  assert.equal(marked({times: {}}, 'build', '1.5'), '1.5', 'older results do not tell');
  assert.equal(marked({times: null}, 'build', '–'), '–');
});

test('the front holds what nothing beats in both', () => {
  const p = (x, y) => ({x, y});
  assert.deepEqual(frontOf([p(3, 1), p(1, 3), p(2, 2), p(2, 3), p(4, 1), p(1, 4)]), [p(1, 3), p(2, 2), p(3, 1)]);
  assert.deepEqual(frontOf([p(1, 1), p(1, 1)]).length, 2);
  assert.deepEqual(frontOf([]), []);
});

test('the marks of the fronts are words, and those of older results are not certain', () => {
  const marks = (cell) => fronts.map((front) => front.of(cell));
  assert.deepEqual(marks({times: {on_time_error_front: 'certainly'}, on_bytes_error_front: 'perhaps'}), ['certainly', 'perhaps']);
  assert.deepEqual(marks({times: {on_time_error_front: true}, on_bytes_error_front: false}), ['perhaps', 'no']);
  assert.deepEqual(marks({times: null}), ['no', 'no']);
});

test('the nodes over the fewest say how many cells they cover', () => {
  const cell = (over, cells = 4096) => ({nodes: {cells, over_fewest: {ratio: 1.25, interval95: [1.2, 1.3], cells: 1010, left_out: 0, ...over}}});
  assert.equal(fewestInterval(cell()), '1.2 to 1.3 (95 %), from 1,010 cells');
  assert.equal(fewestInterval(cell({interval95: [1, 1]})), '1 to 1 (95 %), from 1,010 cells', 'compression=optimal: a share, not all');
  assert.equal(fewestInterval(cell({interval95: [1.25, 1.25], cells: 64, left_out: 3}, 67)), 'all of 64 cells; 3 left out, whose fewest are not known');
  assert.equal(fewestInterval({nodes: {cells: 64}}), null, 'a technique without a tolerance');
});

test('the interval of the RMS says what it covers', () => {
  const cell = (covers) => ({lookup_error: {rms: 0.1, rms_interval95: [0.09, 0.1234], rms_interval_covers: covers}});
  assert.equal(rmsInterval(cell('truth and rays')), 'expected over seeds (95 %): 0.09 to 0.123');
  assert.match(rmsInterval(cell('truth')), /truth only/);
  assert.equal(rmsInterval({lookup_error: {rms: 0.1}}), null);
  assert.equal(rmsInterval({lookup_error: null}), null);
});

test('cells are named by what differs among those of a technique, defaults too', () => {
  const cell = (technique, label, parameters) => ({technique, label, parameters});
  const cells = named([cell('deep', '', {tolerance: 'noise', kernel: 'box', slots: 64}), cell('deep', 'tolerance=0.02 slots=8', {tolerance: 0.02, kernel: 'box', slots: 8}),
    cell('avsm', 'nodes=4', {nodes: 4}), cell('ray_traced', undefined, undefined)]);
  assert.deepEqual(cells.map((c) => c.title), ['deep tolerance=noise slots=64', 'deep tolerance=0.02 slots=8', 'avsm nodes=4', 'ray_traced']);
  const [first, second] = named([cell('deep', 'kernel=tent', {kernel: 'tent', nodes: 8}), cell('deep', 'kernel=tent nodes=4', {kernel: 'tent', nodes: 4})]);
  assert.deepEqual([first.title, first.short, second.short], ['deep kernel=tent nodes=8', 'deep nodes=8', 'deep nodes=4']);
});

const measured = (technique, rms, interval, ns, bytes, more) => ({technique, status: 'ok', verdict: 'kept', bytes, nodes: {cells: bytes}, lookup_error: {rms, rms_interval95: interval},
  times: {lookup_random_order: {ns: {median: ns, interval95: [0.9 * ns, 1.1 * ns]}}}, ...more});

test('the answer at an error counts intervals, and no technique without a map', () => {
  const cells = [measured('fast', 0.03, [0.028, 0.033], 10, 4000), measured('small', 0.02, [0.018, 0.022], 30, 1000), measured('near', 0.025, [0.024, 0.026], 10.5, 9000),
    measured('edge', 0.039, [0.037, 0.045], 1, 10), measured('broken', 0.001, [0.001, 0.001], 1, 1, {verdict: 'failed'}), measured('traced', 0.01, [0.01, 0.01], 5, 0, {nodes: {cells: 0}}),
    {technique: 'none', status: 'failed'}];
  const ask = (budget) => {
    const a = answersAt(cells, {error: errors[0], speed: speeds[0], budget});
    return {...Object.fromEntries(['fastest', 'smallest', 'traced', 'closest'].map((k) => [k, a[k]?.technique ?? null])), rivals: a.rivals.map((c) => c.technique), certain: a.certain};
  };
  assert.deepEqual(ask(0.04), {fastest: 'fast', smallest: 'small', traced: 'traced', closest: null, rivals: ['near'], certain: true}, 'the interval of "edge" reaches beyond it');
  assert.deepEqual(ask(0.022), {fastest: 'small', smallest: 'small', traced: 'traced', closest: null, rivals: [], certain: true});
  assert.deepEqual(ask(0.021), {fastest: 'small', smallest: 'small', traced: 'traced', closest: null, rivals: [], certain: false}, 'its value, not its interval');
  assert.deepEqual(ask(0.005), {fastest: null, smallest: null, traced: null, closest: 'small', rivals: [], certain: false});
  const untimed = answersAt([measured('big', 0.01, null, NaN, 9), measured('small', 0.01, null, NaN, 4)].map((cell) => ({...cell, times: null})), {error: errors[0], speed: speeds[0], budget: 1});
  assert.deepEqual([untimed.fastest, untimed.smallest.technique], [null, 'small'], 'nothing is the fastest without times');
  assert.equal(firstBudget(cells, errors[0]), 0.03, '1.1 times 0.022, rounded up');
  assert.equal(firstBudget([], errors[0]), 0.05);
});

test('the band of the front lies between the good and the bad ends of the intervals', () => {
  const p = (low, high, yLow, yHigh) => ({low, high, yLow, yHigh});
  assert.deepEqual(undecided([p(1, 2, 5, 6), p(4, 4, 1, 2)], 10, 9), [{x: 1, y: 5, y2: 9}, {x: 2, y: 5, y2: 6}, {x: 4, y: 1, y2: 2}, {x: 10, y: 1, y2: 2}]);
  assert.deepEqual(undecided([p(1, 1, 5, 5)], 10, 9), [], 'nothing is undecided');
});

test('a line joins the settings of a technique, from the cheapest', () => {
  const at = (technique, x, y) => ({technique, x, y});
  assert.deepEqual(linesOf([at('avsm', 20, 0.1), at('deep', 5, 0.2), at('avsm', 10, 0.3), at('avsm', 20, 0.2), at('pcf', 1, 1)]),
    [{...at('avsm', 10, 0.3), order: 0}, {...at('avsm', 20, 0.2), order: 1}, {...at('avsm', 20, 0.1), order: 2}]);
  assert.deepEqual(linesOf([at('deep', 5, 0.2), at('pcf', 1, 1)]), [], 'one setting is a point');
});

test('the difference of functions has the steps of both', () => {
  const a = {z: [1, 2, 2, 3], v: [1, 1, 0.5, 0.5]}, b = {z: [1, 3], v: [1, 0]};
  assert.deepEqual(differenceOf(a, b, 0, 4), [[0, 0], [1, 0], [2, 0.5], [2, 0], [3, 0.5], [4, 0.5]]);
  assert.deepEqual(differenceOf({z: [], v: []}, {z: [2, 2], v: [1, 0.25]}, 0, 4), [[0, 0], [2, 0], [2, 0.75], [4, 0.75]], 'an empty function lets all through');
  assert.deepEqual(around({z: [2, 2, 2], v: [1, 0.5, 0.25]}, 2), [1, 0.25]);
});

test('fewer vertices draw the same lines, and keep every step', () => {
  const at = (z, v) => ({z, v}), curve = [at(0, 1), at(1, 0.9), at(1, 0.5), at(4, 0.5)];
  assert.deepEqual(thinned(curve, 1e-3), curve);
  assert.deepEqual(thinned([at(0, 1)], 1e-3), [at(0, 1)]);
  assert.deepEqual(thinned([at(0, 1), at(1, 0.75), at(2, 0.5), at(3, 0.5)], 1e-3), [at(0, 1), at(2, 0.5), at(3, 0.5)]);
  const medium = Array.from({length: 900}, (_, i) => at(i / 100, Math.exp(-i / 300) - (i > 450 ? 0.01 : 0)));
  const fewer = thinned(medium, 1e-3), columns = {z: fewer.map((p) => p.z), v: fewer.map((p) => p.v)};
  assert.ok(fewer.length < 60, `${fewer.length} of 900`);
  for (const {z, v} of medium) assert.ok(Math.abs(around(columns, z)[0] - v) <= 1e-3 + 1e-12, `at ${z}`);
});

test('a recommendation draws what worked, and no bytes of what has no map', () => {
  const axes = [{name: 'resolution', values: ['16', '32']}, {name: 'samples', values: ['4']}];
  const at = (family, step, error, failed = '') => ({family, step: [step, 0], failed, error, lookup_ns: 10 + step, bytes: 100 * family, build_ms: 1});
  const sure = {median: 5, interval95: [4, 6]};
  const settings = settingsOf({families: [{technique: 'traced', name: 'traced', axes, mapless: true}, {technique: 'deep', name: 'deep kernel=box', axes, mapless: false}],
    measured: [at(0, 0, 0.1), at(1, 0, 0.2), at(1, 1, 0.1), at(1, 1, null), at(0, 1, 0.1, 'rises')],
    confirmed: [{family: 1, step: [0, 0], failed: '', error: {mean: 0.21, interval95: [0.2, 0.22]}, lookup_ns: sure, bytes: sure, build_ms: sure}]});
  assert.deepEqual(settings.map((s) => [s.name, s.error, s.confirmed]), [['traced, resolution=16', 0.1, false], ['deep kernel=box, resolution=16', 0.21, true], ['deep kernel=box, resolution=32', 0.1, false]]);
  assert.deepEqual(labelsOf(settings), ['traced', 'deep resolution=16', 'deep resolution=32']);
  const words = (technique, ...all) => ({technique, words: all});
  assert.deepEqual(labelsOf([words('deep', 'kernel=box', 'tolerance=0.1', 'resolution=91'), words('deep', 'kernel=tent', 'tolerance=0.1', 'resolution=91'), words('avsm', 'nodes=4', 'resolution=91')]),
    ['deep kernel=box', 'deep kernel=tent', 'avsm'], 'what all settings of a technique have tells nothing');
  assert.deepEqual(pointsAt(settings, {id: 'lookup_ns'}).map((p) => [p.x, p.xLow, p.low]), [[10, 10, 0.1], [5, 4, 0.2], [11, 11, 0.1]]);
  assert.deepEqual(pointsAt(settings, {id: 'bytes'}).map((p) => p.technique), ['deep', 'deep']);
  assert.deepEqual(ownFronts(pointsAt(settings, {id: 'lookup_ns'})), [{technique: 'deep', x: 5, y: 0.21, order: 0}, {technique: 'deep', x: 11, y: 0.1, order: 1}]);
});

test('results side by side join the cells that both have', () => {
  const result = (cells) => ({variants: [{lights: [{light: 'key', cells}]}]});
  const results = [result([measured('deep', 0.1, null, 10, 100), measured('old', 0.1, null, 10, 100)]), result([measured('deep', 0.2, null, 20, 100), {technique: 'avsm', status: 'failed'}])];
  const {points, lines} = pointsOfAll(results, errors[0], speeds[0]);
  assert.deepEqual(points.map((p) => [p.of, p.title, p.x, p.y]), [[0, 'deep', 10, 0.1], [0, 'old', 10, 0.1], [1, 'deep', 20, 0.2]]);
  assert.deepEqual(lines.map((l) => [l.technique, l.x, l.y, l.order]), [['deep', 10, 0.1, 0], ['deep', 20, 0.2, 1]]);
  const variant = (samples, light) => ({settings: {'/rays/samples_per_pixel': samples}, lights: [{light: 'key', cells: [measured('deep', 0.1, null, 10, 100)]}, {light, cells: [measured('deep', 0.1, null, 10, 100)]}]});
  assert.deepEqual(pointsOfAll([{variants: [variant(4, 'fill'), variant(16, 'fill')]}], errors[0], speeds[0]).points.map((p) => p.short),
    ['deep, samples_per_pixel=4, key', 'deep, samples_per_pixel=4, fill', 'deep, samples_per_pixel=16, key', 'deep, samples_per_pixel=16, fill']);
  assert.deepEqual(overTime(results, speeds[0]), [{title: 'deep', points: [{i: 0, value: 10, low: 9, high: 11}, {i: 1, value: 20, low: 18, high: 22}]}]);
});

test('the worst cell of a function a sample lies in a pixel', () => {
  const map = {width: 32, height: 32, samples_per_pixel: 4, samples_x: 2, samples_y: 2};
  assert.deepEqual(worstPixelOf({curve_error: {worst_cell: [21, 6]}, nodes: {cells: 4096}}, map), [10, 3]);
  assert.deepEqual(worstPixelOf({curve_error: {worst_cell: [21, 6]}, nodes: {cells: 1024}}, map), [21, 6]);
  assert.equal(worstPixelOf({curve_error: null}, map), null);
});

test('the picture of a map is that of its light', () => {
  const images = {lights: [{light: 'key', files: ['light_0.through.exr', 'light_0.through.png']}]};
  assert.equal(lightMapOf(images, {lightIndex: 0, light: {light: 'key'}}), 'light_0.through.png');
  assert.equal(lightMapOf(images, {lightIndex: 0, light: {light: 'other'}}), null);
  assert.equal(lightMapOf({}, {lightIndex: 0, light: {light: 'key'}}), null);
  assert.equal(lightMapOf(null, {lightIndex: 0, light: {light: 'key'}}), null);
});

test('the command of a cell says what was swept, in quotes that a shell takes', () => {
  const result = {name: "it's", scenario: {techniques: [{type: 'deep'}, {type: 'avsm', compression: 'area'}],
    sweeps: {'/techniques/1/nodes': [4, 8], '/rays/samples_per_pixel': [4]}}};
  const cell = {technique: 'avsm', where: '/techniques/1', parameters: {nodes: 8, compression: 'area', other: 1}};
  assert.equal(rerunOf(result, {settings: [['/rays/samples_per_pixel', 4]]}, cell),
    "shadowbench run 'it'\\''s.json' --set 'sweeps={}' --set 'techniques=[{\"type\":\"avsm\",\"compression\":\"area\",\"nodes\":8}]' --set /rays/samples_per_pixel=4");
  assert.equal(quoted('a b'), "'a b'");
});

test('the command of a setting that a recommendation chose names its parameters', () => {
  const result = {name: 'it', scenario: {name: 'it', techniques: [{type: 'deep'}]}};
  const cell = {technique: 'avsm', where: 'technique avsm nodes=8', parameters: {nodes: 8}};
  assert.equal(rerunOf(result, {settings: [['/rays/resolution', 91]]}, cell), `shadowbench run it.json --set 'techniques=[{"type":"avsm","nodes":8}]' --set /rays/resolution=91`);
});

test('the command of a cell that "*" stands for names its technique', () => {
  const result = {name: 'all', scenario: {techniques: [{type: '*'}]}};
  const cell = {technique: 'avsm', where: '/techniques/0', parameters: {nodes: 8}};
  assert.equal(rerunOf(result, {settings: []}, cell), `shadowbench run all.json --set 'techniques=[{"type":"avsm"}]'`);
});

test('a technique has the same mark in every result', () => {
  const of = (...techniques) => seriesOf({variants: [{lights: [{cells: techniques.map((technique) => ({technique}))}]}]});
  const [some, others] = [of('deep', 'ray_traced', 'mine'), of('mine', 'ray_traced', 'avsm', 'deep')];
  for (const name of ['deep', 'ray_traced', 'mine']) assert.equal(some.get(name), others.get(name), name);
  const known = ['shadow_map', 'pcf', 'deep', 'avsm', 'fourier', 'uncompressed', 'ray_traced', 'variance', 'opacity', 'multi_depth', 'volume_deep', 'mine'];
  assert.equal(new Set([...of(...known).values()].map((n) => `${n % 8} ${n % 7}`)).size, known.length, 'no two are alike');
});
