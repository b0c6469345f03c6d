// The measures of every cell over many results, from `shadowbench history`.
import {choice, h} from './dom.js';
import {moment, plural, significant} from './format.js';
import {linearAxis} from './plots/axes.js';
import {plot} from './plots/plot.js';

const {cells, runs} = JSON.parse(document.getElementById('data').textContent);
const {signal} = new AbortController();
const numberOf = new Map(runs.map((run, i) => [run.started, i]));
const indexOf = (run, i) => numberOf.get(run) ?? i;
const short = (commit) => String(commit ?? '').slice(0, 9);

function driftText(measure) {
  const {from, to, ratio, since} = measure.drift;
  return `drifts: ${significant(from)} → ${significant(to)} (${significant(ratio)} ×) since ${moment(since)}`;
}

function drawTrend(measure, place) {
  const points = measure.points.filter((p) => Number.isFinite(p.value)).map((p, i) => ({
    i: indexOf(p.run, i), value: p.value, low: p.low ?? p.value, high: p.high ?? p.value,
    tip: `${significant(p.value)} ${measure.unit}\n${moment(p.run)}\n${short(p.commit)}`,
  }));
  if (!points.length) { place.append(h('p', {class: 'note'}, 'No run has this value.')); return; }
  const values = points.flatMap((p) => [p.low, p.high]);
  const low = Math.min(...values), high = Math.max(...values), room = Math.max((high - low) * 0.12, Math.abs(high) * 0.02);
  const last = Math.max(1, runs.length - 1);
  const drawing = plot('trend', {
    signal, label: `${measure.name} over ${plural(points.length, 'run')}: from ${significant(points[0].value)} to ${significant(points.at(-1).value)} ${measure.unit}`,
    theme: () => ({line: drawing.colour('series-0'), muted: drawing.colour('muted'), alarm: drawing.colour('bad')}),
  });
  const since = measure.drift ? [{i: indexOf(measure.drift.since, 0)}] : [];
  const x = linearAxis('x', -0.4, last + 0.4, Math.min(6, last));
  x.x_ticks = x.x_ticks.filter((t) => Number.isInteger(t));
  x.x_labels = x.x_ticks.map((t) => `#${t + 1}`);
  drawing.update({signals: {...x, ...linearAxis('y', low - room, high + room, 4)}, data: {points, since}});
  place.append(drawing.element);
}

// Draws a plot once it comes into view, since there may be thousands.
const seen = new IntersectionObserver((entries) => {
  for (const {target, isIntersecting} of entries) {
    if (!isIntersecting) continue;
    seen.unobserve(target);
    drawTrend(target.measure, target);
  }
}, {rootMargin: '400px'});

function numbers(measure) {
  return h('details', {}, h('summary', {}, 'Numbers'), h('div', {class: 'scroll'}, h('table', {},
    h('thead', {}, h('tr', {}, ['run', 'commit', 'value', '95 % interval'].map((t) => h('th', {scope: 'col'}, t)))),
    h('tbody', {}, measure.points.map((p) => h('tr', {}, h('td', {}, moment(p.run)), h('td', {}, short(p.commit)), h('td', {class: 'number'}, significant(p.value, 5)),
      h('td', {class: 'number'}, p.low === null || p.low === undefined ? '' : `${significant(p.low)} to ${significant(p.high)}`)))))));
}

function measureView(measure) {
  const place = h('div', {class: 'trend-place'});
  place.measure = measure;
  seen.observe(place);
  return h('figure', {class: measure.drift ? 'trend drifts' : 'trend'}, h('figcaption', {}, h('strong', {}, measure.name), measure.unit && ` ${measure.unit}`),
    measure.drift && h('p', {class: 'drift'}, h('span', {'aria-hidden': 'true'}, '△ '), driftText(measure)), place, numbers(measure));
}

const names = [...new Set(cells.flatMap((c) => c.measures.map((m) => m.name)))];
const list = h('div', {class: 'stack'});
let wanted = '', only = false;
function draw() {
  const fits = (m) => (!wanted || m.name === wanted) && (!only || m.drift);
  const shown = cells.map((cell) => ({cell, measures: cell.measures.filter(fits)})).filter((c) => c.measures.length);
  list.replaceChildren(...shown.map(({cell, measures}) => h('section', {class: 'panel', 'aria-label': cell.title}, h('h2', {}, cell.title),
    h('div', {class: 'trends'}, measures.map(measureView)))));
  if (!shown.length) list.append(h('p', {class: 'empty'}, 'No measure fits these choices.'));
}
draw();
const drifting = cells.reduce((sum, c) => sum + c.measures.filter((m) => m.drift).length, 0);
document.getElementById('main').append(h('div', {class: 'stack'},
  h('div', {class: 'page-head'}, h('h1', {}, 'History'), h('div', {class: 'choices'},
    choice('Measure', [{value: '', text: 'all'}, ...names.map((n) => ({value: n, text: n}))], '', (v) => { wanted = v; draw(); }),
    h('label', {class: 'check'}, h('input', {type: 'checkbox', onchange: (e) => { only = e.target.checked; draw(); }}), ' only what drifts'))),
  h('p', {class: 'purpose'}, `${plural(cells.length, 'cell')} over ${plural(runs.length, 'run')}` +
    (runs.length ? `, from ${moment(runs[0].started)} to ${moment(runs.at(-1).started)}` : '') + `. ${drifting ? plural(drifting, 'measure drifts', 'measures drift') : 'Nothing drifts'}.`),
  h('p', {class: 'note'}, 'The horizontal axis shows the runs; #1 is the first. Bars are 95 % intervals. A dashed line marks the run where a drift begins.'),
  list));
