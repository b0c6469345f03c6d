// What the plots of a group draw: points, the lines between settings of a technique, the front with what is undecided.
import {significant} from '../format.js';
import {write} from '../plots/axes.js';
import {frontOf, fronts, rmsInterval, titleOf, withoutMap} from './model.js';

function interval(measure, m) {
  return m.low !== undefined && m.low !== null && m.high !== m.low
    ? ` (95 %: ${write(measure.kind, m.low)} to ${write(measure.kind, m.high)})` : '';
}

// Whether the result marks the front of these measures, and how: of(cell) is 'no', 'perhaps' or 'certainly'.
export function markedFront(cost, error) {
  return (error.id === 'lookup.rms' && fronts.find((front) => front.cost === cost.id)) || null;
}

// The cells that can be drawn, and why the others cannot. `front`: 'no', 'perhaps', 'certainly' or, without marks, ''.
export function pointsOf(cells, cost, error, chosen) {
  const points = [], missing = [], marks = markedFront(cost, error);
  cells.forEach((cell, index) => {
    const x = cost.of(cell), y = error.of(cell), number = index + 1;
    if (cell.status !== 'ok') missing.push(`${number} failed`);
    else if (!y) missing.push(`${number} has no ${error.text.split(',')[0]}`);
    else if (!x) missing.push(cost.id === 'bytes' && withoutMap(cell) ? `${cell.technique} (${number}) stores no map` : `${number} has no such time`);
    else points.push({
      key: index, technique: cell.technique, texts: [cell.short ?? titleOf(cell), String(number), ''], chosen: index === chosen,
      x: x.value, low: x.low ?? x.value, high: x.high ?? x.value, y: y.value, yLow: y.low ?? y.value, yHigh: y.high ?? y.value,
      front: marks ? marks.of(cell) : '',
      tip: `${number}  ${titleOf(cell)}\n${cost.text}: ${write(cost.kind, x.value)}${interval(cost, x)}\n` +
        `${error.text}: ${significant(y.value)}${error.id === 'lookup.rms' && rmsInterval(cell) ? `\n${rmsInterval(cell)}` : ''}`,
    });
  });
  return {points, missing};
}

// The points of each technique with several settings, from left to right.
export function linesOf(points) {
  const own = new Map();
  for (const p of points) own.set(p.technique, [...own.get(p.technique) ?? [], p]);
  return [...own.values()].filter((some) => some.length > 1)
    .flatMap((some) => [...some].sort((a, b) => a.x - b.x || b.y - a.y).map((p, order) => ({technique: p.technique, x: p.x, y: p.y, order})));
}

// The least error up to each cost, as steps: {x, y}, from left to right.
const stepsOf = (points, x, y) => frontOf(points.map((p) => ({x: p[x], y: p[y]})));

function at(steps, x, otherwise) {
  let y = otherwise;
  for (const step of steps) if (step.x <= x) y = step.y;
  return y;
}

// Between the front at the good ends of all intervals and that at the bad ends: where the front may be. Rows {x, y, y2}
// from left to right, each up to the next; empty if nothing has an interval.
export function undecided(points, right, top) {
  if (!points.some((p) => p.low !== p.high || p.yLow !== p.yHigh)) return [];
  const good = stepsOf(points, 'low', 'yLow'), bad = stepsOf(points, 'high', 'yHigh');
  const places = [...new Set([...good, ...bad].map((s) => s.x))].sort((a, b) => a - b);
  return [...places, right].map((x) => ({x, y: at(good, x, top), y2: at(bad, x, top)}));
}
