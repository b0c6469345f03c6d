// The two plots of a group: speed against error and bytes against error, with the error that is allowed as a line.
import {choice, h, setText} from '../dom.js';
import {significant} from '../format.js';
import {budgetLine} from '../plots/budget.js';
import {labelWidth, plot} from '../plots/plot.js';
import {logAxis, logPlace} from '../plots/axes.js';
import {labelFields, placeLabels} from '../plots/labels.js';
import {levelSample, lookOf} from '../plots/palette.js';
import {saveButtons} from '../plots/save.js';
import {frontOf, errors, size, speeds, titleOf} from './model.js';
import {linesOf, markedFront, pointsOf, undecided} from './points.js';

// Lines mark the errors below which differences mean little, if they apply to the measure.
function levelsOf(light, error, low, high) {
  const reference = light.reference ?? {};
  const all = error.id === 'lookup.rms'
    ? [[reference.spread_over_seeds?.rms, 'spread of the rays over seeds', [2, 4]], [reference.standard_error?.rms, 'standard error of the truth', [8, 4]]]
    : error.id === 'curve.max' ? [[reference.noise_tolerance, 'noise of the rays, 0.5/√N', [2, 4]]] : [];
  return all.filter(([y]) => y > low && y < high).map(([y, text, dash]) => ({y, dash, text: `${text}: ${significant(y, 2)}`}));
}

// What is on the front: by the marks of the result if it marks this one, otherwise by the values as they were measured.
function frontText(points, cells, marked) {
  const names = (some) => some.map((p) => titleOf(cells[p.key])).join(', ');
  if (!marked) return `On the line: ${names(frontOf(points))}. Their intervals are not compared.`;
  return [['certainly', 'Certainly'], ['perhaps', 'Perhaps']].map(([mark, text]) => {
    const some = points.filter((p) => p.front === mark).sort((a, b) => a.x - b.x);
    return some.length ? `${text} on the front: ${names(some)}.` : '';
  }).filter(Boolean).join(' ');
}

const radius = {chosen: 13, other: 8};  // pixels
const sizes = {certainly: 150, perhaps: 130, no: 70, '': 120};  // square pixels
const solid = [1, 0], dashed = [5, 4];

// Steps of the front, each with its own dash: solid where it is certain.
function frontParts(front, right, marked) {
  return front.flatMap((p, part) => {
    const next = front[part + 1] ?? {x: right, y: p.y}, dash = !marked || p.front === 'certainly' ? solid : dashed;
    return [{part, order: 0, x: p.x, y: p.y, dash}, {part, order: 1, x: next.x, y: next.y, dash}];
  });
}

// The points with their labels, for a plot of this size.
function withLabels({points, front, levels, budget}, x, y, width, height) {
  const across = (v) => width * logPlace('x', x.signals, v), down = (v) => height * (1 - logPlace('y', y.signals, v));
  const lines = [
    ...points.flatMap((p) => [[across(p.low), down(p.y), across(p.high), down(p.y)], [across(p.x), down(p.yLow), across(p.x), down(p.yHigh)]]),
    [0, down(budget), width, down(budget)],
    ...levels.map((l) => [0, down(l.y), width, down(l.y)]),
    ...front.slice(1).flatMap((p, i) => [[across(front[i].x), down(front[i].y), across(p.x), down(front[i].y)], [across(p.x), down(front[i].y), across(p.x), down(p.y)]]),
  ];
  const placed = placeLabels({lines, width, height, widthOf: labelWidth, furthest: 34, points: points.map((p) => ({
    x: across(p.x), y: down(p.y), texts: p.texts, radius: p.chosen ? radius.chosen : radius.other, first: p.chosen || p.front !== 'no'}))});
  return points.map((p, i) => ({...p, ...labelFields(placed[i])}));
}

function tradePlot({title, name, pick, moved, series, signal}) {
  const line = budgetLine({label: 'Error that is allowed', moved, signal});
  const drawing = plot('trade', {
    onPick: pick, onFrame: line.frame, label: title, signal,
    theme: () => ({ink: drawing.colour('ink'), muted: drawing.colour('muted'), paper: drawing.colour('panel'), shade: drawing.colour('grid')}),
  });
  const caption = h('p', {class: 'axis-title'}), note = h('p', {class: 'note'}), levelKey = h('ul', {class: 'levels'});
  const yTitle = h('p', {class: 'axis-title'}), place = h('div', {class: 'plot-place'}, drawing.element, line.element);
  let budget = 0.1;
  const save = saveButtons(place, () => `${name()}.${title.split(' ')[0].toLowerCase()}`,
    () => ({title: `${name()}: ${title}`, up: yTitle.textContent, across: caption.textContent, level: `allowed: ${significant(budget)}`}));
  const element = h('figure', {class: 'trade'},
    h('figcaption', {}, h('div', {class: 'figure-head'}, h('h3', {}, title), save), yTitle), place, caption, levelKey, note);
  let axis = null;

  function update({cells, light, cost, error, chosen, budget: allowed}) {
    budget = allowed;
    const {points, missing} = pointsOf(cells, cost, error, chosen), marked = markedFront(cost, error);
    const x = logAxis('x', points.flatMap((p) => [p.x, p.low, p.high]), cost.kind);
    const y = logAxis('y', [...points.flatMap((p) => [p.y, p.yLow, p.yHigh]), ...(points.length ? [] : [budget])], 'error');
    axis = y.signals;
    const inX = (v) => v || x.zero || v, inY = (v) => v || y.zero || v;
    const placed = points.map((p) => {
      const {colour, shape} = lookOf(series().get(p.technique));
      return {...p, colour, shape, fill: p.front === 'perhaps' ? drawing.colour('panel') : colour, size: sizes[p.front],
        x: inX(p.x), low: inX(p.low), high: inX(p.high), y: inY(p.y), yLow: inY(p.yLow), yHigh: inY(p.yHigh)};
    });
    const front = frontOf(placed), right = x.signals.x_high;
    const parts = frontParts(front, right, marked);
    const band = marked ? undecided(placed, right, y.signals.y_high) : [];
    const lines = linesOf(placed).map((p) => ({...p, colour: lookOf(series().get(p.technique)).colour}));
    setText(yTitle, `↑ ${error.text}`);
    setText(caption, `${cost.text} →`);
    setText(note, [
      points.length ? frontText(points, cells, marked) : 'Nothing can be drawn for these measures.',
      x.zero || y.zero ? 'Zeros are drawn at the edge marked 0.' : '', missing.length ? `Not drawn: ${missing.join(', ')}.` : '',
    ].filter(Boolean).join(' '));
    const levels = levelsOf(light, error, y.signals.y_low, y.signals.y_high);
    levelKey.replaceChildren(...levels.map((l) => h('li', {}, levelSample(l.dash), ` ${l.text}`)));
    drawing.update({
      signals: {...x.signals, ...y.signals},
      data: (width, height) => ({points: withLabels({points: placed, front, levels, budget}, x, y, width, height), front: parts, levels, lines, band}),
      description: `${title}: ${cost.text} against ${error.text}, log axes, ${points.length} points. The table below has the numbers.`,
    });
    line.update(budget, axis);
  }
  return {element, update, allow(value) { budget = value; if (axis) line.update(value, axis); }};
}

// context: {series(), name(), pick(index), allow(value, last), choose({error, speed}), signal}. update({cells, light, chosen,
// error, speed, budget}); allow(value) moves the line only.
export function tradeView({series, name, pick, allow, choose, signal}) {
  const common = {series, name, pick, moved: allow, signal};
  const speed = tradePlot({...common, title: 'Speed against error'}), bytes = tradePlot({...common, title: 'Bytes against error'});
  const both = [speed, bytes], choices = h('div', {class: 'choices'});
  const list = (measures) => measures.map((m) => ({value: m.id, text: m.text}));
  const element = h('section', {class: 'panel', 'aria-labelledby': 'trade-title'},
    h('div', {class: 'panel-head'}, h('h2', {id: 'trade-title'}, 'The cost of accuracy'), choices),
    h('div', {class: 'pair'}, speed.element, bytes.element),
    h('p', {class: 'note'}, 'Down and left is better. Drag the line of the error that is allowed, or move it with the arrow keys. ' +
      'Bars are 95 % intervals; thin lines join the settings of a technique. The stepped line joins the points that no other beats in both values as measured. ' +
      'Full marks are certainly on the front, open ones perhaps, small ones not; the front may lie anywhere in the grey band. Click a point, or its name in the table, to see its pictures.'));
  return {
    element,
    update(next) {
      if (!choices.firstChild)
        choices.append(choice('Error', list(errors), next.error.id, (id) => choose({error: id})), choice('Speed', list(speeds), next.speed.id, (id) => choose({speed: id})));
      speed.update({...next, cost: next.speed});
      bytes.update({...next, cost: size});
    },
    allow(value) { for (const one of both) one.allow(value); },
  };
}
