// One technique with one set of parameters: pictures, node histogram, parameters, verdict, the command that runs it.
import {command, download, h} from '../dom.js';
import {bytes, count, plural, significant} from '../format.js';
import {linearAxis} from '../plots/axes.js';
import {glyph} from '../plots/palette.js';
import {plot} from '../plots/plot.js';
import {factorOf, mapLegend, maps} from './legend.js';
import {fewestInterval, fileOf, picturesOf, rerunOf, titleOf, worstPixelOf} from './model.js';
import {verdictMark} from './table.js';

const kinds = [['shaded', 'Shaded'], ['shadow', 'Shadow: average visibility'], ['difference', 'Difference to the reference'], ['heat', '|error| of the shadow']];

function pictureStrip(source, images, cell, signal) {
  const pictures = picturesOf(images, cell);
  if (!pictures) return h('p', {class: 'note'}, 'There are no pictures of this technique.');
  return h('div', {class: 'strip'}, kinds.filter(([kind]) => fileOf(pictures, kind)).map(([kind, text]) => {
    const image = h('img', {alt: `${titleOf(cell)}: ${text.toLowerCase()}`, 'data-kind': kind});
    // A heat map's legend is left out: the text gives its range.
    image.style.aspectRatio = images.resolution.join(' / ');
    source.picture(fileOf(pictures, kind), signal).then((url) => { image.src = url; }, () => { image.alt += ' (not available)'; });
    const error = pictures[kind === 'heat' ? 'shadow' : kind];
    return h('figure', {}, image, h('figcaption', {}, kind === 'difference' ? `${text}, × ${factorOf(images)}` : text,
      (kind === 'shaded' || kind === 'shadow') && error && h('small', {}, ` RMS ${significant(error.rms, 2)}, FLIP ${significant(error.flip_mean, 2)}`)),
    kind in maps && mapLegend(kind, images));
  }));
}

function barsOf(histogram) {
  let last = histogram.length - 1;
  while (last > 0 && histogram[last] === 0) --last;
  const width = Math.ceil((last + 1) / 48);
  const bars = [];
  for (let from = 0; from <= last; from += width) {
    const total = histogram.slice(from, from + width).reduce((sum, n) => sum + n, 0);
    const nodes = width === 1 ? plural(from, 'node') : `${from} to ${from + width - 1} nodes`;
    bars.push({from: from - 0.5, to: from + width - 0.5, count: total, tip: `${nodes}: ${plural(total, 'cell')}`});
  }
  return bars;
}

function histogramOf(cell, series, signal) {
  const nodes = cell.nodes;
  if (!nodes?.histogram?.length || !nodes.cells) return h('p', {class: 'note'}, 'This technique stores no nodes.');
  const bars = barsOf(nodes.histogram);
  const most = Math.max(...bars.map((b) => b.count));
  const across = linearAxis('x', -0.5, bars.at(-1).to, 10);
  const whole = across.x_ticks.filter(Number.isInteger);
  const powers = [0];
  for (let p = 1; p === 1 || powers.at(-1) < most; p *= 10) powers.push(p);
  const drawing = plot('histogram', {
    signal, label: `Histogram of nodes per cell: mean ${significant(nodes.mean)}, largest ${nodes.max}`,
    theme: () => ({bar: drawing.colour(`series-${series % 8}`)}),
  });
  drawing.update({
    signals: {
      ...across, x_ticks: whole, x_labels: whole.map(count),
      y_low: 0, y_high: powers.at(-1), y_ticks: powers, y_labels: powers.map((p) => count(p)),
    },
    data: {bars},
  });
  return h('figure', {class: 'histogram'}, h('figcaption', {}, '↑ cells'), drawing.element,
    h('p', {class: 'axis-title'}, 'nodes a cell →'),
    h('p', {class: 'note'}, `${count(nodes.total)} nodes in ${plural(nodes.cells, 'cell')}: mean ${significant(nodes.mean)}, at most ${count(nodes.max)}.`));
}

// worst(cell): shows the function of the pixel with the largest error; nothing where nobody can be asked for it.
function facts(cell, map, worst) {
  const rows = Object.entries(cell.parameters ?? {});
  const more = [
    ['bytes', `${bytes(cell.bytes)} (${count(cell.bytes)})`], ['peak of the build', bytes(cell.working_bytes)],
    ['version', String(cell.version)],
    cell.curve_error?.worst_cell && ['largest curve error', [`${significant(cell.curve_error.max)} at pixel `, worst && cell.curve_error.max > 0
      ? h('button', {type: 'button', class: 'link', onclick: () => worst(cell)}, worstPixelOf(cell, map).join(', ')) : worstPixelOf(cell, map).join(', ')]],
    cell.nodes?.over_fewest && ['nodes over the fewest', `${significant(cell.nodes.over_fewest.ratio, 4)}: ${fewestInterval(cell)}`],
    cell.lookup_error && ['mean signed error', significant(cell.lookup_error.signed_mean, 2)],
  ].filter(Boolean);
  const list = (entries) => h('dl', {class: 'facts'}, entries.map(([k, v]) => h('div', {}, h('dt', {}, k), h('dd', {}, v))));
  return [
    h('h3', {class: 'part'}, 'Parameters'), rows.length ? list(rows.map(([k, v]) => [k, typeof v === 'string' ? v : JSON.stringify(v)])) : h('p', {class: 'note'}, 'It has none.'),
    h('h3', {class: 'part'}, 'Measured'), list(more),
  ];
}

// source: see view.js. The signal aborts when another cell is shown.
export function cellView({source, result, images, group, cell, index, series, worst, signal}) {
  const scenario = () => download(`${result.name}.json`, 'application/json', `${JSON.stringify(result.scenario, null, 2)}\n`);
  return h('section', {class: 'panel', id: 'cell', 'aria-labelledby': 'cell-title', tabindex: '-1'},
    h('div', {class: 'panel-head'},
      h('h2', {id: 'cell-title'}, h('span', {class: 'index'}, String(index + 1)), glyph(series), ` ${titleOf(cell)}`),
      verdictMark(cell)),
    h('p', {class: 'why'}, cell.status === 'ok' ? cell.verdict_why ?? '' : cell.reason),
    pictureStrip(source, images, cell, signal),
    h('div', {class: 'pair'},
      h('div', {}, h('h3', {class: 'part'}, 'Nodes'), histogramOf(cell, series, signal)),
      h('div', {}, facts(cell, group.light.map, worst))),
    h('h3', {class: 'part'}, 'Run only this cell again'),
    command(rerunOf(result, group, cell)),
    h('p', {class: 'note'}, 'with the scenario as ', h('button', {type: 'button', class: 'link', onclick: scenario}, `${result.name}.json`), '.'));
}
