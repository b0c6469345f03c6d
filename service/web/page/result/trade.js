// The two plots of a group: speed against error and bytes against error.
import {choice, h, setText} from '../dom.js';
import {significant} from '../format.js';
import {plot} from '../plots/plot.js';
import {logAxis, logPlace, write} from '../plots/axes.js';
import {placeLabels} from '../plots/labels.js';
import {levelSample, lookOf} from '../plots/palette.js';
import {errors, frontOf, fronts, rmsInterval, size, speeds, titleOf} from './model.js';

function interval(measure, m) {
  return m.low !== undefined && m.low !== null && m.high !== m.low
    ? ` (95 %: ${write(measure.kind, m.low)} to ${write(measure.kind, m.high)})` : '';
}

// The cells that can be drawn, and why the others cannot.
function pointsOf(cells, series, cost, error, chosen) {
  const points = [], missing = [];
  cells.forEach((cell, index) => {
    const x = cost.of(cell), y = error.of(cell);
    if (cell.status !== 'ok') missing.push(`${index + 1} failed`);
    else if (!y) missing.push(`${index + 1} has no ${error.text.split(',')[0]}`);
    else if (!x) missing.push(`${index + 1} has no such time`);
    else {
      const look = lookOf(series.get(cell.technique));
      points.push({
        n: String(index + 1), key: index, x: x.value, low: x.low ?? x.value, high: x.high ?? x.value, y: y.value,
        colour: look.colour, shape: look.shape, chosen: index === chosen,
        tip: `${index + 1}  ${titleOf(cell)}\n${cost.text}: ${write(cost.kind, x.value)}${interval(cost, x)}\n` +
          `${error.text}: ${significant(y.value)}${error.id === 'lookup.rms' && rmsInterval(cell) ? `\n${rmsInterval(cell)}` : ''}`,
      });
    }
  });
  return {points, missing};
}

// Lines mark the errors below which differences mean little, if they apply to the measure.
function levelsOf(light, error, low, high) {
  const reference = light.reference ?? {};
  const all = error.id === 'lookup.rms'
    ? [[reference.spread_over_seeds?.rms, 'spread of the rays over seeds', [2, 4]], [reference.standard_error?.rms, 'standard error of the truth', [8, 4]]]
    : error.id === 'curve.max' ? [[reference.noise_tolerance, 'noise of the rays, 0.5/√N', [2, 4]]] : [];
  return all.filter(([y]) => y > low && y < high).map(([y, text, dash]) => ({y, dash, text: `${text}: ${significant(y, 2)}`}));
}

// What is on the front: by the marks of the result if it marks this one, otherwise by the values as they were measured.
function frontText(points, cells, cost, error) {
  const names = (some) => some.map((p) => `${p.n} ${titleOf(cells[p.key])}`).join(', ');
  const marked = error.id === 'lookup.rms' && fronts.find((front) => front.cost === cost.id);
  if (!marked) return `On the line: ${names(frontOf(points))}. Their intervals are not compared.`;
  return [['certainly', 'Certainly'], ['perhaps', 'Perhaps']].map(([mark, text]) => {
    const some = points.filter((p) => marked.of(cells[p.key]) === mark).sort((a, b) => a.x - b.x);
    return some.length ? `${text} on the front: ${names(some)}.` : '';
  }).filter(Boolean).join(' ');
}

const radius = {chosen: 13, other: 8};  // pixels

// The points with the positions of their numbers, for a plot of this size.
function withLabels({points, front, levels}, x, y, width, height) {
  const across = (v) => width * logPlace('x', x.signals, v), down = (v) => height * (1 - logPlace('y', y.signals, v));
  const lines = [
    ...points.map((p) => [across(p.low), down(p.y), across(p.high), down(p.y)]),
    ...levels.map((l) => [0, down(l.y), width, down(l.y)]),
    ...front.slice(1).flatMap((p, i) => [[across(front[i].x), down(front[i].y), across(p.x), down(front[i].y)], [across(p.x), down(front[i].y), across(p.x), down(p.y)]]),
  ];
  const placed = placeLabels({lines, width, height,
    points: points.map((p) => ({x: across(p.x), y: down(p.y), text: p.n, radius: p.chosen ? radius.chosen : radius.other}))});
  return points.map((p, i) => ({...p, ...placed[i]}));
}

function tradePlot(title, pick, signal) {
  const drawing = plot('trade', {
    onPick: pick, label: title, signal,
    theme: () => ({ink: drawing.colour('ink'), muted: drawing.colour('muted'), paper: drawing.colour('panel')}),
  });
  const caption = h('p', {class: 'axis-title'}), note = h('p', {class: 'note'}), levelKey = h('ul', {class: 'levels'});
  const yTitle = h('p', {class: 'axis-title'});
  const element = h('figure', {class: 'trade'},
    h('figcaption', {}, h('h3', {}, title), yTitle), drawing.element, caption, levelKey, note);

  function update({cells, light, series, cost, error, chosen}) {
    const {points, missing} = pointsOf(cells, series, cost, error, chosen);
    const x = logAxis('x', points.flatMap((p) => [p.x, p.low, p.high]), cost.kind);
    const y = logAxis('y', points.map((p) => p.y), 'error');
    const front = frontOf(points).map((p, order) => ({order, x: p.x || x.zero, y: p.y || y.zero}));
    if (front.length) front.push({order: front.length, x: x.signals.x_high, y: front.at(-1).y});
    const placed = points.map((p) => ({
      ...p, x: p.x || x.zero, low: p.low || x.zero || p.low, high: p.high || x.zero, y: p.y || y.zero,
    }));
    setText(yTitle, `↑ ${error.text}`);
    setText(caption, `${cost.text} →`);
    setText(note, [
      points.length ? frontText(points, cells, cost, error) : 'Nothing can be drawn for these measures.',
      x.zero || y.zero ? 'Zeros are drawn at the edge marked 0.' : '', missing.length ? `Not drawn: ${missing.join(', ')}.` : '',
    ].filter(Boolean).join(' '));
    const levels = levelsOf(light, error, y.signals.y_low, y.signals.y_high);
    levelKey.replaceChildren(...levels.map((l) => h('li', {}, levelSample(l.dash), ` ${l.text}`)));
    drawing.update({
      signals: {...x.signals, ...y.signals},
      data: (width, height) => ({points: withLabels({points: placed, front, levels}, x, y, width, height), front, levels}),
      description: `${title}: ${cost.text} against ${error.text}, log axes, ${points.length} points. The table below has the numbers.`,
    });
  }
  return {element, update};
}

// context: {series, pick(index), signal}. update({cells, light, chosen}).
export function tradeView(context) {
  let cost = speeds[0], error = errors[0], last = null;
  const speed = tradePlot('Speed against error', context.pick, context.signal);
  const bytes = tradePlot('Bytes against error', context.pick, context.signal);
  const draw = () => {
    speed.update({...last, series: context.series(), cost, error});
    bytes.update({...last, series: context.series(), cost: size, error});
  };
  const find = (list, id) => list.find((m) => m.id === id);
  const element = h('section', {class: 'panel', 'aria-labelledby': 'trade-title'},
    h('div', {class: 'panel-head'}, h('h2', {id: 'trade-title'}, 'The cost of accuracy'),
      h('div', {class: 'choices'},
        choice('Error', errors.map((m) => ({value: m.id, text: m.text})), error.id, (id) => { error = find(errors, id); draw(); }),
        choice('Speed', speeds.map((m) => ({value: m.id, text: m.text})), cost.id, (id) => { cost = find(speeds, id); draw(); }))),
    h('div', {class: 'pair'}, speed.element, bytes.element),
    h('p', {class: 'note'}, 'Down and left is better. Bars: 95 % intervals of the median. The line joins the points that no other beats in both values as measured; where their intervals are known, the text below says which are certain. ' +
      'Click a point, or its name in the table, to see its pictures.'));
  return {element, update(next) { last = next; draw(); }};
}
