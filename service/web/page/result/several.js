// The cells of several results side by side. Cells are the same if their variant, light and title are.
import {groupsOf, titleOf} from './model.js';

const briefly = (settings) => settings.map(([pointer, value]) => `${pointer.split('/').at(-1)}=${typeof value === 'string' ? value : JSON.stringify(value)}`).join(' ');

// All cells of a result: {title, short, cell}. Both names have the variant and the light where there are several; `short` is
// for labels in plots.
function cellsOf(result) {
  const groups = groupsOf(result), variants = new Set(groups.map((g) => g.variant)).size > 1, lights = new Set(groups.map((g) => g.light.light)).size > 1;
  const joined = (...parts) => parts.filter(Boolean).join(', ');
  return groups.flatMap((g) => g.cells.map((cell) => ({cell,
    title: joined(titleOf(cell), variants && g.variantTitle, lights && g.light.light), short: joined(cell.short, variants && briefly(g.settings), lights && g.light.light)})));
}

// results: from the oldest. points: {of, technique, title, short, x, low, high, y, tip}; lines join a cell over the results.
export function pointsOfAll(results, error, cost) {
  const points = results.flatMap((result, of) => cellsOf(result).flatMap(({cell, title, short}) => {
    const x = cell.status === 'ok' && cost.of(cell), y = x && error.of(cell);
    return y ? [{of, technique: cell.technique, title, short, x: x.value, low: x.low ?? x.value, high: x.high ?? x.value, y: y.value, tip: `#${of + 1} ${title}`}] : [];
  }));
  const lines = [...new Set(points.map((p) => p.title))].flatMap((title) => {
    const own = points.filter((p) => p.title === title);
    return own.length > 1 ? own.map((p, order) => ({technique: title, of: p.technique, x: p.x, y: p.y, order})) : [];
  });
  return {points, lines};
}

// The cells that two results or more have: [{title, points: [{i, value, low, high}]}].
export function overTime(results, measure) {
  const trends = new Map();
  results.forEach((result, i) => {
    for (const {cell, title} of cellsOf(result)) {
      const m = cell.status === 'ok' && measure.of(cell);
      if (m) trends.set(title, [...trends.get(title) ?? [], {i, value: m.value, low: m.low ?? m.value, high: m.high ?? m.value}]);
    }
  });
  return [...trends].filter(([, points]) => points.length > 1).map(([title, points]) => ({title, points}));
}
