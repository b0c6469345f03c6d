// Several results in one plot, and each technique over time.
import {address} from './address.js';
import {get} from './api.js';
import {choice, h, setText} from './dom.js';
import {bytes, moment, plural} from './format.js';
import {linearAxis, logAxis, logPlace, write} from './plots/axes.js';
import {labelFields, placeLabels} from './plots/labels.js';
import {numberOf} from './plots/numbers.js';
import {glyph, lookOf, onThemeChange} from './plots/palette.js';
import {labelWidth, plot} from './plots/plot.js';
import {saveButtons} from './plots/save.js';
import {errors, size, speeds} from './result/model.js';
import {overTime, pointsOfAll} from './result/several.js';

const most = 12;  // results at a time
const fewPoints = 24;  // have room for the number of their result
const measures = [...speeds, size];
const commitOf = (result) => String(result.program?.commit ?? '?').slice(0, 9);

// Ticks at round numbers, of bytes in the unit that they are written in.
function roundAxis(kind, low, high) {
  const unit = kind === 'bytes' ? 1024 ** Math.max(0, Math.floor(Math.log2(high) / 10)) : 1, axis = linearAxis('y', low / unit, high / unit, 4);
  const ticks = axis.y_ticks.map((v) => v * unit);
  return {y_low: axis.y_low * unit, y_high: axis.y_high * unit, y_ticks: ticks, y_labels: ticks.map((v) => (kind === 'bytes' ? bytes(v, 5) : write(kind, v)))};
}

function trendOf({title, points}, measure, results, signal) {
  const values = points.flatMap((p) => [p.low, p.high]), low = Math.min(...values), high = Math.max(...values), room = Math.max((high - low) * 0.12, Math.abs(high) * 0.02);
  const drawing = plot('trend', {signal, label: `${title}, ${measure.text}: ${points.map((p) => write(measure.kind, p.value)).join(', ')}`,
    theme: () => ({line: drawing.colour('series-0'), muted: drawing.colour('muted'), alarm: drawing.colour('bad')})});
  const x = linearAxis('x', -0.4, results.length - 0.6, Math.min(6, results.length - 1));
  x.x_ticks = results.map((_, i) => i);
  x.x_labels = results.map((_, i) => `#${i + 1}`);
  drawing.update({signals: {...x, ...roundAxis(measure.kind, low - room, high + room)}, data: {since: [], points: points.map((p) => ({...p,
    tip: `${write(measure.kind, p.value)}\n${moment(results[p.i].result.times?.started)}\n${commitOf(results[p.i].result)}`}))}});
  return h('figure', {class: 'trend'}, h('figcaption', {}, h('strong', {}, title)), drawing.element);
}

export function exploreView({signal}) {
  const problem = h('p', {class: 'problem', role: 'alert'}), list = h('div', {class: 'boxes wide'}), place = h('div', {class: 'stack'});
  let shown = new AbortController(), turn = 0;
  signal.addEventListener('abort', () => shown.abort(), {once: true});
  const asked = () => (address.get('jobs') ?? '').split(',').filter(Boolean).slice(0, most);
  const known = new Map();
  const fetchOne = async (id) => {
    if (!known.has(id)) known.set(id, await get(`/v1/jobs/${encodeURIComponent(id)}/result`, signal));
    return known.get(id);
  };
  const word = (name, all) => all.find((m) => m.id === address.get(name)) ?? all[0];

  function overlay(results, error, cost) {
    const drawing = plot('trade', {label: 'Several results', signal: shown.signal,
      theme: () => ({ink: drawing.colour('ink'), muted: drawing.colour('muted'), paper: drawing.colour('panel'), shade: drawing.colour('grid')})});
    const {points, lines} = pointsOfAll(results.map((r) => r.result), error, cost);
    const box = h('div', {class: 'plot-place'}, drawing.element), titles = [...new Set(points.map((p) => p.technique))];
    const x = logAxis('x', points.flatMap((p) => [p.x, p.low, p.high]), cost.kind), y = logAxis('y', points.map((p) => p.y), 'error');
    const look = (p) => lookOf(numberOf(p.technique)), zero = (v, axis) => v || axis.zero || v;
    const drawn = points.map((p, key) => ({...p, key, ...look(p), fill: p.of === results.length - 1 ? look(p).colour : drawing.colour('panel'), size: 90, chosen: false,
      x: zero(p.x, x), low: zero(p.low, x), high: zero(p.high, x), y: zero(p.y, y), yLow: zero(p.y, y), yHigh: zero(p.y, y)}));
    drawing.update({
      signals: {...x.signals, ...y.signals}, description: `${points.length} points of ${plural(results.length, 'result')}: ${cost.text} against ${error.text}, log axes.`,
      data(width, height) {
        const latest = (p) => p.of === results.length - 1, number = (p) => (drawn.length > fewPoints ? [] : [`#${p.of + 1}`]);
        const placed = placeLabels({lines: [], width, height, widthOf: labelWidth, furthest: 13, points: drawn.map((p) => ({x: width * logPlace('x', x.signals, p.x), y: height * (1 - logPlace('y', y.signals, p.y)), radius: 7,
          texts: [...latest(p) ? [p.short] : [], ...number(p), ''], first: latest(p)}))});
        return {points: drawn.map((p, i) => ({...p, ...labelFields(placed[i])})), front: [], levels: [], band: [],
          lines: lines.map((l) => ({...l, x: zero(l.x, x), y: zero(l.y, y), colour: lookOf(numberOf(l.of)).colour}))};
      },
    });
    return h('section', {class: 'panel', 'aria-labelledby': 'overlay-title'},
      h('div', {class: 'panel-head'}, h('h2', {id: 'overlay-title'}, 'In one plot'), saveButtons(box, () => 'results', () => ({title: 'Several results', up: `↑ ${error.text}`, across: `${cost.text} →`}))),
      h('p', {class: 'axis-title'}, `↑ ${error.text}`), box, h('p', {class: 'axis-title across'}, `${cost.text} →`),
      h('ul', {class: 'levels'}, titles.map((technique) => h('li', {}, glyph(numberOf(technique)), ` ${technique}`))),
      h('p', {class: 'note'}, 'Full marks are of the last result, open ones of those before. A line joins a cell over the results. Point at a mark for its name.'));
  }

  async function draw() {
    const mine = ++turn, ids = asked();
    for (const box of list.querySelectorAll('input')) {
      box.checked = ids.includes(box.value);
      box.disabled = !box.checked && ids.length >= most;
    }
    shown.abort();
    shown = new AbortController();
    setText(problem, '');
    if (!ids.length) return place.replaceChildren(h('p', {class: 'empty'}, 'Choose results of the same scenario, from several versions of the program or with other settings.'));
    const answers = await Promise.allSettled(ids.map(async (id) => ({id, result: await fetchOne(id)})));
    if (signal.aborted || mine !== turn) return;
    setText(problem, answers.flatMap(({reason}, i) => (reason ? [`${ids[i]}: ${reason.message}`] : [])).join(' '));
    const results = answers.flatMap(({value}) => value ?? []).sort((a, b) => new Date(a.result.times?.started) - new Date(b.result.times?.started));
    const focused = document.activeElement?.closest('[data-part]')?.dataset.part;
    place.replaceChildren(...(results.length ? partsOf(results) : []));
    if (focused) place.querySelector(`[data-part="${focused}"] select`)?.focus();
  }

  function partsOf(results) {
    const error = word('error', errors), cost = word('cost', measures), which = [...measures, ...errors], over = word('over', which);
    const pick = (name, label, all, now) => {
      const picker = choice(label, all.map((m) => ({value: m.id, text: m.text})), now.id, (id) => { address.go({[name]: id}); draw(); });
      picker.dataset.part = name;
      return picker;
    };
    const changes = ({points}) => Math.max(...points.map((p) => p.value)) !== Math.min(...points.map((p) => p.value));
    // Those that change come first.
    const trends = results.length > 1 ? overTime(results.map((r) => r.result), over).sort((a, b) => changes(b) - changes(a)) : [];
    return [
      h('ol', {class: 'results'}, results.map((r, i) => h('li', {}, h('a', {href: `#/jobs/${r.id}`}, `#${i + 1} ${r.result.name}`),
        ` ${moment(r.result.times?.started)}, ${r.result.program?.version ?? '?'} (${commitOf(r.result)})`))),
      h('div', {class: 'choices'}, pick('error', 'Error', errors, error), pick('cost', 'Cost', measures, cost)), overlay(results, error, cost),
      results.length > 1 && h('section', {class: 'panel', 'aria-labelledby': 'time-title'}, h('div', {class: 'panel-head'}, h('h2', {id: 'time-title'}, 'Over time'), pick('over', 'Measure', which, over)),
        trends.length ? h('div', {class: 'trends'}, trends.map((t) => trendOf(t, over, results, shown.signal))) : h('p', {class: 'note'}, 'No cell of one has this measure in another.')),
    ].filter(Boolean);
  }
  get('/v1/jobs?state=succeeded&limit=100', signal).then(({jobs}) => {
    list.replaceChildren(...jobs.filter((job) => job.kind !== 'recommendation').map((job) => h('label', {class: 'check'}, h('input', {type: 'checkbox', value: job.id, onchange: (event) => {
      const ids = asked().filter((id) => id !== job.id);
      address.go({jobs: (event.target.checked ? [...ids, job.id] : ids).join(',') || null});
      draw();
    }}), `${job.name}, ${moment(job.created)}, ${job.id}`)));
    draw();
  }, (error) => { if (!signal.aborted) setText(problem, error.message); });
  addEventListener('hashchange', draw, {signal});
  onThemeChange(draw, signal);
  return h('div', {class: 'stack'}, h('div', {class: 'page-head'}, h('h1', {tabindex: '-1'}, 'Explore results')),
    h('section', {class: 'panel', 'aria-label': 'Results'}, list), problem, place);
}
