// A whole result: summary, plots, table, one technique, pictures, visibility functions. A source gives access to its data:
//   picture(file, signal)            a promise of the URL of a picture named in images.json
//   curves(group, x, y, signal)      a promise of the functions of a pixel; absent without a server
import {choice, h} from '../dom.js';
import {bytes, count, moment, plural, seconds, significant} from '../format.js';
import {onThemeChange} from '../plots/palette.js';
import {cellView} from './cell.js';
import {compareView} from './compare.js';
import {curvesView} from './curves.js';
import {fronts, groupsOf, imagesAreOf, originOf, picturesOf, seriesOf, unsettledOf} from './model.js';
import {cellTable} from './table.js';
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

// The cell that is shown first: it kept its promises, and few others beat it.
function bestOf(cells) {
  const places = ['no', 'perhaps', 'certainly'];
  const [time, bytes] = fronts.map((front) => (cell) => places.indexOf(front.of(cell)));
  const score = (cell) => 9 * (cell.verdict === 'kept') + 3 * bytes(cell) + time(cell);
  return cells.reduce((best, cell, i) => (score(cell) > score(cells[best]) ? i : best), 0);
}

// The part of a result for one variant and light; chosen() is called with the cell that is shown.
function groupView({source, result, images, imagesFault, group, series, signal}) {
  const theseImages = imagesAreOf(images, group) ? images : null;
  const drawn = theseImages && group.cells.findIndex((cell) => picturesOf(theseImages, cell));
  let chosen = bestOf(group.cells);
  let shown = new AbortController();
  signal.addEventListener('abort', () => shown.abort(), {once: true});

  const trade = tradeView({series: () => series, pick: (index) => pick(index, true), signal});
  const tablePlace = h('div'), cellPlace = h('div', {'aria-live': 'polite'});
  const compare = theseImages && drawn >= 0 ? compareView({source, images: theseImages, cells: group.cells, signal}) : null;

  function pick(index, focus) {
    chosen = index;
    shown.abort();
    shown = new AbortController();
    const cell = group.cells[index];
    trade.update({cells: group.cells, light: group.light, chosen});
    const focused = document.activeElement?.dataset?.cell;
    tablePlace.replaceChildren(cellTable({cells: group.cells, series, chosen, pick: (i) => pick(i, true)}));
    cellPlace.replaceChildren(cellView({
      source, result, images: theseImages, group, cell, index, series: series.get(cell.technique), signal: shown.signal,
    }));
    if (focused !== undefined) tablePlace.querySelector(`[data-cell="${focused}"]`)?.focus();
    compare?.update(index);
    if (focus) cellPlace.scrollIntoView({block: 'nearest', behavior: 'smooth'});
  }
  if (group.cells.length) pick(chosen, false);
  onThemeChange(() => { if (group.cells.length) pick(chosen, false); }, signal);

  const unsettled = unsettledOf(result, group);
  return h('div', {class: 'stack'},
    unsettled && h('p', {class: 'unsettled', role: 'note'}, h('strong', {}, 'Unsettled. '),
      `${unsettled}. Times may be off by as much, and the front of time and error and rankings by time with them. ` +
      'Run it again on a quiet machine.'),
    h('section', {class: 'panel quiet-panel', 'aria-label': 'Capture'}, captureOf(group.light, originOf(result, group)),
      group.light.sees_nothing && h('p', {class: 'note'}, 'This light sees nothing that casts a shadow.')),
    trade.element,
    h('section', {class: 'panel', 'aria-labelledby': 'table-title'}, h('h2', {id: 'table-title'}, 'All figures'), tablePlace),
    cellPlace,
    compare?.element ?? h('section', {class: 'panel quiet-panel'}, h('p', {class: 'note'},
      images ? 'The pictures show another variant.'
        : imagesFault ? ['Pictures could not be made: ', imagesFault.where && h('code', {}, imagesFault.where), ` ${imagesFault.message}.`] : 'There are no pictures of this result.')),
    source.curves ? curvesView({source, result, images: theseImages, group, series, signal}) : null);
}

// imagesFault: why there are no pictures, as {where, message}, if it is known.
export function resultView({source, result, images, imagesFault, signal}) {
  const groups = groupsOf(result), series = seriesOf(result);
  const place = h('div');
  let shown = null, current = groups[0];

  function show(group) {
    shown?.abort();
    shown = new AbortController();
    current = group;
    place.replaceChildren(groupView({source, result, images, imagesFault, group, series, signal: shown.signal}));
  }
  signal.addEventListener('abort', () => shown?.abort(), {once: true});
  if (!groups.length) return h('p', {class: 'note'}, 'This result has no lights.');

  const variants = [...new Map(groups.map((g) => [g.variant, g])).values()];
  const lightsOf = (variant) => groups.filter((g) => g.variant === variant);
  const lightPlace = h('span');
  const lightChoice = () => {
    const lights = lightsOf(current.variant);
    lightPlace.replaceChildren(...(lights.length > 1 ? [choice('Light', lights.map((g) => ({value: g.lightIndex, text: g.light.light})), current.lightIndex,
      (l) => show(groups.find((g) => g.variant === current.variant && g.lightIndex === Number(l))))] : []));
  };
  const variantChoice = variants.length > 1 && choice('Variant', variants.map((g) => ({value: g.variant, text: g.variantTitle})), current.variant, (v) => {
    const lights = lightsOf(Number(v));
    show(lights.find((g) => g.lightIndex === current.lightIndex) ?? lights[0]);
    lightChoice();
  });
  lightChoice();
  show(current);
  const several = groups.length > 1;
  return h('div', {class: 'stack'}, several && h('div', {class: 'choices switch'}, variantChoice, lightPlace), place);
}
