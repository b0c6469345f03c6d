// What the page reckons without a browser: places in JSON, its address, the form, axes, numbers.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {address, changed, numbersOf, pathOf} from '../../../service/web/page/address.js';
import {keepsDigits, lightPlace, typesOf, withLight, withPart, withRays, withTypes} from '../../../service/web/page/choices.js';
import {bytes, csvOf, nanoseconds, seconds, significant, written} from '../../../service/web/page/format.js';
import {JsonFault, lineOf, offsetOf, places} from '../../../service/web/page/pointer.js';
import {linearAxis, logAxis, logPlace} from '../../../service/web/page/plots/axes.js';
import {placeLabels} from '../../../service/web/page/plots/labels.js';

test('a pointer leads to where its value stands', () => {
  const text = '{"a": [1, {"b/c": true, "d~": "x"}],\n "e": {}}';
  const map = places(text);
  const at = (pointer) => text.slice(offsetOf(map, pointer), offsetOf(map, pointer) + 5);
  assert.equal(at('/a/0'), '1, {"');
  assert.equal(at('/a/1/b~1c'), '"b/c"');
  assert.equal(at('/a/1/d~0'), '"d~":');
  assert.equal(at('/e'), '"e": ');
  assert.equal(at('/e/missing/deeper'), '"e": ');
  assert.equal(offsetOf(map, '/nothing'), 0);
  assert.equal(offsetOf(map, 'no pointer'), 0);
  assert.equal(lineOf(text, offsetOf(map, '/e')), 1);
});

test('the scanner takes what JSON.parse takes, and nothing else', () => {
  const good = ['1', '-0.5e-3', '"\\u00e9\\n"', '[]', '{}', ' [ 1 , 2 ] ', '{"a":{"b":[null,true,false]}}', '"\u2028"'];
  const bad = ['', ' ', '01', '1.', '+1', '.5', 'NaN', '"', '"\n"', '"\\x"', '[1,]', '[,1]', '{"a"}', '{"a":}', '{"a":1,}', '{a:1}', '[1', '1 2', "'a'", 'tru', '{"a":1}}'];
  for (const text of good) { JSON.parse(text); places(text); }
  for (const text of bad) {
    assert.throws(() => JSON.parse(text), text);
    assert.throws(() => places(text), JsonFault, text);
  }
  assert.throws(() => places('['.repeat(5000)), JsonFault);
});

test('random changes of a scenario are judged as JSON.parse does', () => {
  const text = '{"name": "x", "list": [1, 2.5e3, "a\\"b", {"t": true, "n": null}], "o": {}}';
  let seed = 1;
  const random = (n) => { seed = (seed * 48271) % 2147483647; return seed % n; };
  for (let i = 0; i < 3000; ++i) {
    const at = random(text.length), changed = text.slice(0, at) + '{}[],:"\\01 e.-nt'[random(16)] + text.slice(at + random(2));
    let valid = true;
    try { JSON.parse(changed); } catch { valid = false; }
    let seen = true;
    try { places(changed); } catch (error) { assert.ok(error instanceof JsonFault); seen = false; }
    assert.equal(seen, valid, changed);
  }
});

test('labels of close points cover neither points nor each other', () => {
  const [width, height, radius] = [300, 200, 8];
  const points = [[150, 100], [158, 104], [150, 112], [2, 2], [299, 199], [298, 100]].map(([x, y], i) => ({x, y, radius, texts: ['a name that is far too long for this small plot', String(i + 1)]}));
  const placed = placeLabels({points, lines: [[0, 100, 300, 100]], width, height});
  assert.deepEqual(placed.map((p) => p.text), ['1', '2', '3', '4', '5', '6'], 'numbers, where names have no room');
  const boxes = placed.map(({dx, dy}, i) => [points[i].x + dx, points[i].y + dy]);
  boxes.forEach(([x, y], i) => {
    assert.ok(x > 3 && x < width - 3 && y > 6 && y < height - 6, `${i} is inside`);
    for (const p of points) assert.ok(Math.abs(p.x - x) >= radius + 3 || Math.abs(p.y - y) >= radius + 6, `${i} covers a point`);
    boxes.slice(0, i).forEach(([u, v]) => assert.ok(Math.abs(u - x) >= 7 || Math.abs(v - y) >= 13, `${i} covers a label`));
  });
});

test('what is first gets the name, where there is room for one', () => {
  const point = (y, first) => ({x: 50, y, radius: 8, texts: ['twelve chars', 'n'], first});
  const texts = (points) => placeLabels({points, lines: [], width: 165, height: 34}).map((p) => p.text);
  assert.deepEqual(texts([point(10, false), point(24, true)]), ['n', 'twelve chars']);
  assert.deepEqual(texts([point(17, false)]), ['twelve chars']);
});

test('a label whose near places are taken stands further away, or gives way', () => {
  const around = [[-22, -14], [0, -18], [22, -14], [-22, 0], [22, 0], [-22, 14], [0, 18], [22, 14]].map(([x, y]) => ({x: 200 + x, y: 100 + y, radius: 8, texts: ['']}));
  const at = (furthest) => placeLabels({points: [{x: 200, y: 100, radius: 8, texts: ['name', '']}, ...around], lines: [], width: 400, height: 200, furthest})[0];
  assert.equal(at(6).text, '');
  assert.equal(at(undefined).text, 'name');
  assert.ok(Math.hypot(at(undefined).dx, at(undefined).dy) > 30);
  const {dx, dy, lead: {from, to}} = at(undefined);
  assert.ok(Math.abs(Math.hypot(...from) - 8) < 1e-9, 'a line begins at the edge of the mark');
  assert.ok(Math.abs(to[0] - dx) <= 18 && Math.abs(to[1] - dy) <= 7, 'and ends at the label');
  const [alone] = placeLabels({points: [{x: 200, y: 100, radius: 8, texts: ['name']}], lines: [], width: 400, height: 200});
  assert.equal(alone.lead, null, 'a label beside its own mark needs none');
});

test('an address keeps what is shown, and is read with care', () => {
  assert.equal(changed('#/jobs/j-1', {technique: 3, pixel: '4,5'}), '#/jobs/j-1?technique=3&pixel=4,5');
  assert.equal(changed('#/jobs/j-1?technique=3&pixel=4,5', {technique: null, zoom: '2,-0.5,0'}), '#/jobs/j-1?pixel=4,5&zoom=2,-0.5,0');
  assert.equal(changed('#/jobs/j-1?a=1', {a: null}), '#/jobs/j-1');
  assert.equal(changed('', {a: 1}), '#?a=1', 'a report has no path');
  assert.equal(pathOf('#/jobs/j-1?a=1'), '#/jobs/j-1');
  assert.equal(pathOf(''), pathOf('#?a=1'), 'Back to the start of a report stays in it');
  assert.deepEqual(numbersOf('4,-0.5', 2), [4, -0.5]);
  for (const bad of ['4', '4,', 'a,b', '1,2,3', '', null, undefined, '1,Infinity']) assert.equal(numbersOf(bad, 2), null, String(bad));
});

test('an address that changes all the time is written now and then, and never that of another page', (t) => {
  t.mock.timers.enable({apis: ['setTimeout', 'Date'], now: 1e6});
  const written = [];
  globalThis.location = {hash: '#/jobs/j-1'};
  globalThis.history = Object.fromEntries(['pushState', 'replaceState'].map((how) => [how, (_, __, next) => { written.push([how, next]); location.hash = next; }]));
  for (let i = 1; i <= 40; ++i) address.keep({zoom: i});
  assert.deepEqual(written, [['replaceState', '#/jobs/j-1?zoom=1']], 'browsers refuse a hundred');
  t.mock.timers.tick(300);
  assert.deepEqual(written.slice(1), [['replaceState', '#/jobs/j-1?zoom=40']], 'the last is not lost');
  address.keep({zoom: 41});
  address.go({pixel: '1,2'});
  assert.deepEqual(written.slice(2), [['replaceState', '#/jobs/j-1?zoom=41'], ['pushState', '#/jobs/j-1?zoom=41&pixel=1,2']], 'a step comes after what waits');
  address.keep({zoom: 42});
  location.hash = '#/jobs';
  t.mock.timers.tick(1000);
  assert.equal(written.length, 4);
  assert.equal(address.get('zoom'), null);
});

test('a form changes what it shows, and nothing else', () => {
  const scenario = {lights: [{type: 'spot', position: [3, 4, 0], target: [0, 0, 0], angle: 40}, {type: 'directional', direction: [0, -1, 0]}], rays: {resolution: 64, seed: 3},
    techniques: [{type: 'deep', tolerance: 0.1}, {type: 'avsm'}, {type: 'deep', tolerance: 0.2}], sweeps: {'/techniques/1/nodes': [4, 8], '/techniques/2/tolerance': [0.3], '/rays/resolution': [32, 64]}};
  assert.deepEqual(lightPlace(scenario), {around: 0, height: 53});
  const moved = withLight(scenario, {around: 90, height: 0});
  assert.deepEqual(moved.lights, [{...scenario.lights[0], position: [moved.lights[0].position[0], 0, 5]}, scenario.lights[1]]);
  assert.ok(Math.abs(moved.lights[0].position[0]) < 1e-12);
  assert.equal(lightPlace({lights: [{type: 'point', position: [1, 2, 3]}]}), null);
  assert.equal(lightPlace({}), null);
  const sun = withLight({lights: [{type: 'directional', direction: [0, -2, 0]}]}, {around: 0, height: 30}).lights[0].direction;
  assert.deepEqual(sun.map((v) => Number(v.toFixed(3))), [-1.732, -1, 0]);
  const lying = {lights: [{type: 'directional', direction: [0.35, -0.5, -1]}], receivers: {type: 'camera', up: [0, 0, 1]}, sweeps: {'/lights/0/direction': [[0, 0, -1]]}};
  assert.deepEqual(lightPlace(lying), lightPlace({lights: [{direction: [-0.5, -1, 0.35]}]}), 'z is up');
  assert.deepEqual(withLight(lying, {around: 0, height: 90}).sweeps, {}, 'a sweep would set it again');
  assert.deepEqual(withLight(lying, {around: 0, height: 30}).lights[0].direction.map((v) => Number(v.toFixed(3))), [0, -1.015, -0.586]);
  assert.deepEqual(withRays(scenario, 'resolution', 128), {...scenario, rays: {resolution: 128, seed: 3}, sweeps: {'/techniques/1/nodes': [4, 8], '/techniques/2/tolerance': [0.3]}});
  const all = ['deep', 'avsm', 'pcf'];
  const fewer = withTypes(scenario, new Set(['avsm', 'pcf']), all);
  assert.deepEqual(fewer.techniques, [{type: 'avsm'}, {type: 'pcf'}]);
  assert.deepEqual(fewer.sweeps, {'/techniques/0/nodes': [4, 8], '/rays/resolution': [32, 64]}, 'a sweep follows its technique, or goes with it');
  assert.deepEqual([...typesOf({techniques: [{type: '*'}]}, all)], all);
  assert.deepEqual(withTypes({techniques: [{type: '*'}]}, new Set(['deep', 'pcf']), all).techniques, [{type: 'deep'}, {type: 'pcf'}]);
  assert.ok(keepsDigits('{"a": 1234567890, "b": "12345678901234567890"}'));
  assert.ok(!keepsDigits('{"a": 12345678901234567890}'));
});

test('a part of a scenario is merged key by key, and no sweep sets it again', () => {
  const scenario = {name: 'x', rays: {resolution: 64, seed: 3}, receivers: {type: 'camera', footprint: {radius: 2}}, techniques: [{type: 'deep'}, {type: 'pcf'}],
    sweeps: {'/rays/seed': [1, 2], '/rays/resolution': [32, 64], '/techniques/1/res_factor': [1, 2], '/lights/0/angle': [20, 30]}};
  assert.deepEqual(withPart(scenario, {rays: {resolution: 91}, techniques: [{type: 'avsm', nodes: 8}]}), {...scenario, rays: {resolution: 91, seed: 3},
    techniques: [{type: 'avsm', nodes: 8}], sweeps: {'/rays/seed': [1, 2], '/lights/0/angle': [20, 30]}});
  assert.deepEqual(withPart({name: 'x', techniques: []}, {receivers: {footprint: {share: 0.1}}}), {name: 'x', techniques: [], receivers: {footprint: {share: 0.1}}});
});

test('CSV quotes what would break it', () => {
  assert.equal(csvOf([['a', 'b,c', 'say "x"'], [1.5, null, undefined]]), 'a,"b,c","say ""x"""\r\n1.5,,\r\n');
});

test('a log axis has a place for each value', () => {
  const signals = {x_low: 1, x_high: 100};
  assert.deepEqual([1, 10, 100, 0.1, 1000].map((v) => logPlace('x', signals, v)), [0, 0.5, 1, 0, 1]);
});

test('a log axis holds all values, and zero has a place below them', () => {
  for (const values of [[1, 1000], [3e-4, 0.5], [5], [], [0, 0], [0, 1e6], [1e-200, 1e200]]) {
    const {zero, signals} = logAxis('x', values, 'error');
    for (const v of values) if (v > 0) assert.ok(v >= signals.x_low && v <= signals.x_high, `${values}`);
    assert.equal(zero !== null, values.includes(0));
    if (zero) {
      assert.ok(zero > 0 && zero >= signals.x_low && values.every((v) => v === 0 || v > zero));
      assert.equal(signals.x_labels[0], '0');
    }
    assert.ok(signals.x_low > 0 && Number.isFinite(signals.x_high));
    assert.equal(signals.x_ticks.length, signals.x_labels.length);
    assert.ok(signals.x_ticks.length <= 20, `${signals.x_ticks.length} ticks`);
  }
  for (const kind of ['ns', 'bytes', 'error']) for (const v of [5, 23.4, 1000, 4e5]) {
    const {signals} = logAxis('x', [v], kind);
    assert.ok(new Set(signals.x_labels).size >= 2, `a single ${kind} of ${v}: ${signals.x_labels}`);
  }
  assert.deepEqual(logAxis('x', [1024, 1 << 20], 'bytes').signals.x_labels, ['1 KiB', '4 KiB', '16 KiB', '64 KiB', '256 KiB', '1 MiB']);
});

test('a linear axis has round ticks inside', () => {
  const axis = linearAxis('x', 5.63, 10.45);
  assert.deepEqual(axis.x_ticks, [6, 7, 8, 9, 10]);
  assert.ok(linearAxis('x', 2, 2).x_high > 2);
});

test('numbers read as people write them', () => {
  assert.equal(significant(0.0361234), '0.0361');
  assert.equal(significant(12345.6), '12,346');
  assert.equal(significant(999.9), '1000');
  assert.equal(significant(1.5e-7), '1.5e-07');
  assert.equal(significant(null), '–');
  assert.equal(significant(0.5 / 3, 2), '0.17');
  assert.equal(bytes(0), '0 B');
  assert.equal(bytes(609852), '596 KiB');
  assert.equal(nanoseconds(32385), '32.4 µs');
  assert.equal(nanoseconds(2.5e9), '2.5 s');
  assert.equal(seconds(90), '1 min 30 s');
  assert.equal(seconds(59.99), '60 s');
});

// The page and the report share these functions; tests/base holds the tables of the program to the same texts.
test('the same number has the same text as in the tables of the program', () => {
  const lines = readFileSync(new URL('../../base/number_texts.txt', import.meta.url), 'utf8').trim().split('\n');
  assert.ok(lines.length > 20);
  for (const line of lines) {
    const [, kind, value, text] = /^(\w+) (\S+) (.+)$/.exec(line);
    assert.equal(kind === 'error' ? significant(Number(value), 2) : bytes(Number(value)), text, line);
    if (kind === 'error' && Number(value)) assert.equal(significant(-Number(value), 2), `-${text}`);
  }
});

test('a scenario is written with what fits a line on one', () => {
  const document = {name: 'x', corner: [1, 2, 3], deep: [{type: 'deep', t: 0.1}, {long: 'y'.repeat(100)}], none: {}, list: []};
  const text = written(document);
  assert.deepEqual(JSON.parse(text), document);
  assert.match(text, /\n  "corner": \[1, 2, 3\],\n/);
  assert.match(text, /\n    \{"type": "deep", "t": 0.1\},\n/);
  assert.deepEqual(JSON.parse(written({a: 'two  [ spaces ]\n'})), {a: 'two  [ spaces ]\n'});
});
