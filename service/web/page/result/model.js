// Derives what the page shows from a result (result.json of `run`): groups of cells, measures, the front, the command of a
// cell.

import {count, plural, significant} from '../format.js';
import {numberOf} from '../plots/numbers.js';
import {named} from './names.js';

export function titleOf(cell) {
  return cell.title ?? (cell.label ? `${cell.technique} ${cell.label}` : cell.technique);
}

// Whether it traces rays: it stores nothing, so it has no place among maps.
export function withoutMap(cell) {
  return cell.bytes === 0 && !cell.nodes?.cells;
}

const sample = (s) => s && {value: s.median, low: s.interval95?.[0], high: s.interval95?.[1]};
const plain = (value) => (Number.isFinite(value) ? {value} : null);

// Each of(cell) gives {value, low, high} or nothing. kind: how numbers are written.
export const speeds = [
  {id: 'random', text: 'one lookup, random order', kind: 'ns', of: (c) => sample(c.times?.lookup_random_order?.ns)},
  {id: 'image', text: 'one lookup, image order', kind: 'ns', of: (c) => sample(c.times?.lookup_image_order?.ns)},
  {id: 'random_floor', text: 'random order, × floor', kind: 'ratio',
    of: (c) => sample(c.times?.lookup_random_order?.ratio_to_floor)},
  {id: 'image_floor', text: 'image order, × floor', kind: 'ratio',
    of: (c) => sample(c.times?.lookup_image_order?.ratio_to_floor)},
  {id: 'build', text: 'build', kind: 'ms', of: (c) => sample(c.times?.build_ms)},
];

export const size = {id: 'bytes', text: 'bytes of the map', kind: 'bytes', of: (c) => (withoutMap(c) ? null : plain(c.bytes))};

const norms = [['rms', 'RMS'], ['max', 'largest'], ['p99', '99th percentile'], ['mean', 'mean']];
export const errors = [['lookup', 'lookup error'], ['curve', 'curve error']].flatMap(([kind, name]) =>
  norms.map(([id, text]) => ({
    id: `${kind}.${id}`, text: `${name}, ${text}`, kind: 'error', of: (c) => errorOf(c[`${kind}_error`], id),
  })));

// Lookup errors have an interval of their RMS.
function errorOf(error, id) {
  const value = plain(error?.[id]), interval = id === 'rms' && error?.rms_interval95;
  return value && interval ? {...value, low: interval[0], high: interval[1]} : value;
}

// The 95 % interval of the RMS that is expected over seeds of the rays, as text. Older results have none.
export function rmsInterval(cell) {
  const error = cell.lookup_error;
  if (!error?.rms_interval95) return null;
  const [low, high] = error.rms_interval95;
  return `expected over seeds (95 %): ${significant(low)} to ${significant(high)}` +
    (error.rms_interval_covers === 'truth' ? ', for the uncertainty of the truth only' : '');
}

// What the ratio of nodes to the fewest covers, as text. Only techniques with a tolerance have one.
export function fewestInterval(cell) {
  const over = cell.nodes?.over_fewest;
  if (!over) return null;
  const [low, high] = over.interval95;
  // A share of a map whose cells all have the same ratio has an interval without width.
  const all = over.cells + over.left_out >= cell.nodes.cells;
  return (all ? `all of ${plural(over.cells, 'cell')}` : `${significant(low, 4)} to ${significant(high, 4)} (95 %), from ${plural(over.cells, 'cell')}`) +
    (over.left_out ? `; ${count(over.left_out)} left out, whose fewest are not known` : '');
}

// The marks of a front: 'no', 'perhaps' or 'certainly', by intervals. Older results have true or false, without intervals.
const word = (mark) => (mark === true ? 'perhaps' : mark || 'no');
export const fronts = [
  {letter: 'T', cost: 'random', text: 'time and error', of: (c) => word(c.times?.on_time_error_front)},
  {letter: 'B', cost: 'bytes', text: 'bytes and error', of: (c) => word(c.on_bytes_error_front)},
];

// A group for each variant and light.
export function groupsOf(result) {
  return (result.variants ?? []).flatMap((variant, v) => (variant.lights ?? []).map((light, l) => {
    const settings = Object.entries(variant.settings ?? {});
    return {
      variant: v, lightIndex: l, settings, light,
      variantTitle: settings.map(([pointer, value]) => `${pointer.slice(1).replaceAll('/', '.')} = ${JSON.stringify(value)}`)
        .join(', ') || 'as written',
      cells: named(light.cells ?? []),
    };
  }));
}

// Where and when a group of a merged result was measured; nothing for other results.
export function originOf(result, group) {
  return result.times?.cells?.find((cell) => cell.variant === group.variant && cell.light === group.lightIndex) ?? null;
}

// Why the times of a group are unreliable: the machine was disturbed, or some intervals are wide. Nothing if they are settled.
export function unsettledOf(result, group) {
  return result.times?.unsettled?.find((u) => u.variant === group.variant && u.light === group.light.light)?.why ?? null;
}

// The text of a time of a cell, with a mark if its interval is wider than the goal. `order` names it in times.settled.
export const marked = (cell, order, text) => (text && cell.times?.settled?.[order] === false ? `~${text}` : text);

// The Pareto front of the values, without their intervals: the points that no other point beats in both measures, from left to
// right. Equal points are all on it.
export function frontOf(points) {
  const sorted = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
  const front = [];
  for (const point of sorted) {
    const last = front.at(-1);
    if (!last || point.y < last.y || (point.y === last.y && point.x === last.x)) front.push(point);
  }
  return front;
}

// The numbers of the techniques of a result.
export function seriesOf(result) {
  const series = new Map();
  for (const group of groupsOf(result))
    for (const cell of group.cells)
      series.set(cell.technique, numberOf(cell.technique));
  return series;
}

function valueAt(document, pointer) {
  return pointer.split('/').slice(1).reduce((value, key) => value?.[key.replaceAll('~1', '/').replaceAll('~0', '~')], document);
}

// The technique in the form of a scenario: the values that were written, and those that sweeps set. A recommendation's
// stand nowhere in its scenario.
function techniqueOf(result, cell) {
  const written = cell.where?.startsWith('/') ? valueAt(result.scenario, cell.where) : null;
  if (!written) return {type: cell.technique, ...cell.parameters};
  if (written.type === '*') return {type: cell.technique};  // "*" stands for techniques with their defaults
  const swept = Object.keys(result.scenario?.sweeps ?? {}).filter((p) => p.startsWith(`${cell.where}/`))
    .map((p) => p.slice(cell.where.length + 1)).filter((key) => key in (cell.parameters ?? {}));
  return {...written, ...Object.fromEntries(swept.map((key) => [key, cell.parameters[key]]))};
}

export function quoted(text) {
  return /^[\w\-./=:,+@%]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

// The command that runs only this cell, from the scenario saved as a file.
export function rerunOf(result, group, cell) {
  const sets = [];
  if (Object.keys(result.scenario?.sweeps ?? {}).length) sets.push('sweeps={}');
  sets.push(`techniques=${JSON.stringify([techniqueOf(result, cell)])}`);
  for (const [pointer, value] of group.settings) sets.push(`${pointer}=${JSON.stringify(value)}`);
  return ['shadowbench', 'run', `${result.name}.json`, ...sets.flatMap((s) => ['--set', s])].map(quoted).join(' ');
}

// The pictures of a cell in images.json; nothing when there are none.
export function picturesOf(images, cell) {
  return images?.techniques?.find((t) => t.technique === cell.technique && (t.label ?? '') === (cell.label ?? '')) ?? null;
}

export function fileOf(pictures, kind) {
  return pictures?.files?.find((name) => name.endsWith(`.${kind}.png`)) ?? null;
}

// The picture of a light's map, as images.json names it.
export function lightMapOf(images, group) {
  const light = images?.lights?.[group.lightIndex];
  return light?.light === group.light.light ? fileOf(light, 'through') : null;
}

// The pixel of the largest curve error. The result names a cell; for a function per sample, cells are samples.
export function worstPixelOf(cell, map) {
  const at = cell.curve_error?.worst_cell;
  if (!at) return null;
  const samples = cell.nodes?.cells === map.width * map.height * map.samples_per_pixel;
  return samples ? [Math.floor(at[0] / map.samples_x), Math.floor(at[1] / map.samples_y)] : at;
}

// Whether the pictures show this variant: they exist only for one.
export function imagesAreOf(images, group) {
  const settings = images?.settings ?? {};
  return Boolean(images) && group.settings.length === Object.keys(settings).length &&
    group.settings.every(([pointer, value]) => JSON.stringify(settings[pointer]) === JSON.stringify(value));
}
