// A whole result: summary, plots, table, one technique, pictures, visibility functions. A source gives access to its data:
//   picture(file, signal)            a promise of the URL of a picture named in images.json
//   curves(group, x, y, signal)      a promise of the functions of a pixel; absent without a server
import {address, pathOf} from '../address.js';
import {choice, download, h} from '../dom.js';
import {bytes, count, csvOf, moment, plural, seconds, significant} from '../format.js';
import {onThemeChange} from '../plots/palette.js';
import {answersAt, firstBudget} from './answers.js';
import {answerView} from './answer.js';
import {cellView} from './cell.js';
import {compareView} from './compare.js';
import {curvesView} from './curves.js';
import {errors, groupsOf, imagesAreOf, originOf, picturesOf, seriesOf, speeds, unsettledOf, withoutMap} from './model.js';
import {cellTable, figures} from './table.js';
import {tradeView} from './trade.js';

function facts(entries) {
  return h('dl', {class: 'facts'}, entries.filter(Boolean).map(([term, text]) => h('div', {}, h('dt', {}, term), h('dd', {}, text))));
}

function machineText(machine, node) {
  return `${node ? `${node}, ` : ''}${machine?.cpu ?? '?'}, ${plural(machine?.logical_cores ?? 0, 'core')}`;
}

// Of a result that was merged, the machines of its cells, if there are several.
function machinesOf(result) {
  const machines = new Set((result.times?.cells ?? []).map((cell) => machineText(cell.machine, cell.node)));
  return machines.size > 1 ? [...machines].join('; ') : machineText(result.machine);
}

export function summaryOf(result) {
  const verdicts = groupsOf(result).flatMap((g) => g.cells).reduce((all, cell) => {
    const verdict = cell.verdict ?? cell.status;
    return all.set(verdict, (all.get(verdict) ?? 0) + 1);
  }, new Map());
  return facts([
    ['Verdicts', [...verdicts].map(([verdict, n]) => `${n} ${verdict}`).join(', ') || 'none'],
    ['Run', `${moment(result.times?.started)}, ${seconds(result.times?.seconds)}`],
    ['Machine', machinesOf(result)],
    ['Program', `${result.program?.version ?? '?'} (${result.program?.commit ?? '?'})`],
    ['Scenario', result.scenario_hash ?? '?'],
    result.only?.length && ['Only', result.only.join(', ')],
    result.files?.length && ['Data files', result.files.join('; ')],
    result.notes?.length && ['Notes on data files', result.notes.join('; ')],
  ]);
}

// `origin`: of the group, in a merged result.
function captureOf(light, origin) {
  const map = light.map ?? {}, reference = light.reference ?? {};
  return facts([
    ['Map', `${map.width} × ${map.height}, ${plural(map.samples_per_pixel, 'ray')} a pixel (${map.pattern})`],
    ['Rays', `${count(light.rays)} with ${plural(light.segments, 'segment')}, ${bytes(light.ray_bytes)}`],
    ['Receivers', `${count(reference.judged)} of ${count(light.receivers)} judged; ${count(light.receivers_outside_map)} outside the map`],
    ['Truth', `${reference.samples_per_pixel} rays a pixel, standard error ${significant(reference.standard_error?.rms, 2)}`],
    ['Noise', `0.5/√N ${significant(reference.noise_tolerance, 2)}` +
      (reference.spread_over_seeds ? `, spread over seeds ${significant(reference.spread_over_seeds.rms, 2)}` : '')],
    light.capture?.embree_check && ['Embree', light.capture.embree_check.agrees ? 'agrees' : 'DIFFERS'],
    origin && ['Measured on', machineText(origin.machine, origin.node)],
  ]);
}

// The part of a result for one variant and light. What is chosen stands in the address.
function groupView({source, result, images, imagesFault, asked, group, series, signal}) {
  const theseImages = imagesAreOf(images, group) ? images : null;
  const drawn = theseImages && group.cells.findIndex((cell) => picturesOf(theseImages, cell));
  const {cells} = group;
  let error = errors.find((m) => m.id === (address.get('error') ?? asked?.error)) ?? errors[0], speed = speeds.find((m) => m.id === address.get('speed')) ?? speeds[0];
  const allowed = address.numbers('budget', 1)?.[0];
  const usualBudget = () => (asked && error.id === asked.error ? asked.budget : firstBudget(cells, error));
  let budget = allowed > 0 ? allowed : usualBudget();
  const first = () => {
    const {fastest, smallest, closest} = answersAt(cells, {error, speed, budget});
    const best = fastest ?? smallest ?? closest ?? cells.find((cell) => !withoutMap(cell));
    return Math.max(0, cells.indexOf(best));
  };
  const wanted = Number(address.get('technique')) - 1;
  let chosen = Number.isInteger(wanted) && wanted >= 0 && wanted < cells.length ? wanted : first();
  let shown = new AbortController();
  signal.addEventListener('abort', () => shown.abort(), {once: true});

  // The error that is allowed; `last`: no further value follows at once.
  function allow(value, last) {
    budget = value;
    trade.allow(value);
    answer.update({cells, series, error, speed, budget});
    if (last) address.keep({budget: value});
  }
  function choose(measures) {
    address.go({...measures, ...(measures.error && {budget: null})});
    error = errors.find((m) => m.id === measures.error) ?? error;
    speed = speeds.find((m) => m.id === measures.speed) ?? speed;
    if (measures.error) budget = usualBudget();
    draw();
  }
  const answer = answerView({among: asked !== null, pick: (index) => pick(index, true), allow});
  const trade = tradeView({series: () => series, name: () => result.name ?? 'result', pick: (index) => pick(index, true), allow, choose, signal});
  const tablePlace = h('div'), cellPlace = h('div', {'aria-live': 'polite'});
  const compare = theseImages && drawn >= 0 ? compareView({source, images: theseImages, cells, picked: (index) => pick(index, false), signal}) : null;
  const curves = source.curves ? curvesView({source, result, images: theseImages, group, series, signal}) : null;

  function draw() {
    answer.update({cells, series, error, speed, budget});
    trade.update({cells, light: group.light, chosen, error, speed, budget});
  }
  function pick(index, focus) {
    address.go({technique: index + 1});
    show(index);
    if (focus) cellPlace.scrollIntoView({block: 'nearest', behavior: 'smooth'});
  }
  function show(index) {
    chosen = index;
    shown.abort();
    shown = new AbortController();
    const cell = cells[index];
    draw();
    const focused = document.activeElement?.dataset?.cell;
    tablePlace.replaceChildren(cellTable({cells, series, chosen, pick: (i) => pick(i, true)}));
    cellPlace.replaceChildren(cellView({
      source, result, images: theseImages, group, cell, index, series: series.get(cell.technique), worst: curves?.worst, signal: shown.signal,
    }));
    if (focused !== undefined) tablePlace.querySelector(`[data-cell="${focused}"]`)?.focus();
    compare?.update(index);
  }
  if (cells.length) show(chosen);
  onThemeChange(() => { if (cells.length) show(chosen); }, signal);

  const unsettled = unsettledOf(result, group);
  const csv = () => download(`${result.name ?? 'result'}.csv`, 'text/csv', csvOf(figures(cells)));
  return h('div', {class: 'stack'},
    answer.element,
    unsettled && h('details', {class: 'unsettled'}, h('summary', {}, h('strong', {}, 'Unsettled. '), 'Times, and all that is ranked by time, may be off. Run it again on a quiet machine.'),
      h('p', {}, `${unsettled}. Times may be off by as much, and the front of time and error with them.`)),
    trade.element,
    h('section', {class: 'panel', 'aria-labelledby': 'table-title'},
      h('div', {class: 'panel-head'}, h('h2', {id: 'table-title'}, 'All figures'), h('button', {type: 'button', class: 'quiet small', onclick: csv, 'aria-label': 'Save the table as CSV'}, 'CSV')), tablePlace),
    cellPlace,
    compare?.element ?? h('section', {class: 'panel quiet-panel', 'aria-label': 'Pictures'}, h('p', {class: 'note'},
      images ? 'The pictures show another variant.'
        : imagesFault ? ['Pictures could not be made: ', imagesFault.where && [h('code', {}, imagesFault.where), ': '], `${imagesFault.message}.`] : 'There are no pictures of this result.')),
    curves?.element,
    h('section', {class: 'panel quiet-panel', 'aria-label': 'Capture'}, captureOf(group.light, originOf(result, group)),
      group.light.sees_nothing && h('p', {class: 'note'}, 'This light sees nothing that casts a shadow.')));
}

// imagesFault: why there are no pictures, as {where, message}, if it is known. first: settings of the variant that is shown
// first, as {pointer: value}; nothing: the first one. asked: {error, budget} of a recommendation, the id of its measure and its error.
export function resultView({source, result, images, imagesFault, first = {}, asked = null, signal}) {
  const groups = groupsOf(result), series = seriesOf(result);
  if (!groups.length) return h('p', {class: 'note'}, 'This result has no lights.');
  const place = h('div'), switches = h('div', {class: 'choices switch', hidden: groups.length === 1});
  let shown = null, current = null;
  signal.addEventListener('abort', () => shown?.abort(), {once: true});

  const variants = [...new Map(groups.map((g) => [g.variant, g])).values()];
  const lightsOf = (variant) => groups.filter((g) => g.variant === variant);
  const usual = groups.find((g) => Object.entries(first).every(([pointer, value]) => g.settings.some(([p, v]) => p === pointer && v === value))) ?? groups[0];
  // What the address names, or the usual one.
  function named() {
    const lights = lightsOf(Number(address.get('variant') ?? usual.variant));
    return lights.find((g) => g.lightIndex === Number(address.get('light') ?? -1)) ?? lights[0] ?? groups[0];
  }
  function go(group) {
    address.go({variant: group.variant, light: group.lightIndex, technique: null, pixel: null, budget: null, depth: null, channel: null});
    show();
  }
  function show() {
    current = named();
    shown?.abort();
    shown = new AbortController();
    const lights = lightsOf(current.variant), focused = document.activeElement?.closest('.switch .choice')?.dataset.part;
    const part = (name, element) => { element.dataset.part = name; return element; };
    switches.replaceChildren(...[
      variants.length > 1 && part('variant', choice('Variant', variants.map((g) => ({value: g.variant, text: g.variantTitle})), current.variant, (v) => {
        const there = lightsOf(Number(v));
        go(there.find((g) => g.lightIndex === current.lightIndex) ?? there[0]);
      })),
      lights.length > 1 && part('light', choice('Light', lights.map((g) => ({value: g.lightIndex, text: g.light.light})), current.lightIndex,
        (l) => go(groups.find((g) => g.variant === current.variant && g.lightIndex === Number(l))))),
    ].filter(Boolean));
    if (focused) switches.querySelector(`[data-part="${focused}"] select`)?.focus();
    place.replaceChildren(groupView({source, result, images, imagesFault, asked, group: current, series, signal: shown.signal}));
  }
  show();
  // Back and forward within this result, and an address that is typed.
  const path = pathOf(location.hash);
  addEventListener('hashchange', () => { if (pathOf(location.hash) === path) show(); }, {signal});
  return h('div', {class: 'stack'}, switches, place);
}
