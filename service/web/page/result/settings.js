// What a recommendation measured: every setting, and which are confirmed.
import {frontOf} from './model.js';

export const costs = [{id: 'lookup_ns', text: 'one lookup', kind: 'ns'}, {id: 'bytes', text: 'bytes of the map', kind: 'bytes'}, {id: 'build_ms', text: 'build', kind: 'ms'}];

const axesAt = ({axes}, step) => axes.map((axis, i) => ({word: `${axis.name}=${axis.values[step[i]]}`, has: axis.values[step[i]] !== '', chosen: axis.values.length > 1}));

function nameOf(family, step) {
  const settings = axesAt(family, step).filter((axis) => axis.chosen).map((axis) => axis.word);
  return `${family.name}${settings.length ? `, ${settings.join(' ')}` : ''}`;
}

// A setting as the answer names it.
export function settingText({name, axes}, step) {
  const word = (axis, i) => `${axis.name}=${axis.values[step[i]]}`;
  const own = axes.map((axis, i) => i >= 2 && ` ${word(axis, i)}`), rays = axes.map((axis, i) => i < 2 && (axis.values.length > 1 || axis.values[0] !== '') && ` ${word(axis, i)}`);
  const [settings, light] = [own, rays].map((all) => all.filter(Boolean).join(''));
  return name + settings + (light && `,${light}`);
}

// Labels of settings in a plot: the technique and, of its words, those in which these settings of it differ.
export function labelsOf(settings) {
  return settings.map(({technique, words}) => {
    const own = settings.filter((s) => s.technique === technique);
    return [technique, ...words.filter((word) => !own.every((s) => s.words.includes(word)))].join(' ');
  });
}

// The settings that work: {technique, words, name, error, low, high, confirmed, mapless, costs: {id: {value, low, high}}}.
// `words`: all that tells it from others of its technique, such as kernel=box.
export function settingsOf({families, measured, confirmed}) {
  const key = (point) => `${point.family}:${point.step}`;
  const surely = new Map(confirmed.map((one) => [key(one), one]));
  return measured.flatMap((one) => {
    const family = families[one.family], found = surely.get(key(one));
    if (one.failed || found?.failed || !Number.isFinite(one.error)) return [];
    const [low, high] = found ? found.error.interval95 : [one.error, one.error];
    const sample = (id) => (found ? {value: found[id].median, low: found[id].interval95[0], high: found[id].interval95[1]} : {value: one[id], low: one[id], high: one[id]});
    return [{technique: family.technique, words: [...family.name.split(' ').slice(1), ...axesAt(family, one.step).filter((axis) => axis.has).map((axis) => axis.word)], name: nameOf(family, one.step), confirmed: Boolean(found), mapless: family.mapless,
      error: found ? found.error.mean : one.error, low, high, costs: Object.fromEntries(costs.map(({id}) => [id, sample(id)]))}];
  });
}

// What can be drawn for a cost: techniques without a map have no bytes and no build.
export function pointsAt(settings, cost) {
  return settings.filter((s) => s.costs[cost.id].value > 0 && s.error > 0 && !(s.mapless && cost.id !== 'lookup_ns'))
    .map((s) => ({...s, x: s.costs[cost.id].value, xLow: s.costs[cost.id].low, xHigh: s.costs[cost.id].high, y: s.error}));
}

// The settings of each technique that no other of its own beats.
export function ownFronts(points) {
  const own = new Map();
  for (const p of points) own.set(p.technique, [...own.get(p.technique) ?? [], p]);
  return [...own].flatMap(([technique, some]) => (some.length > 1 ? frontOf(some).map((p, order) => ({technique, x: p.x, y: p.y, order})) : []));
}
