// The cells of a group as a table, which is the legend of the plots and has the same numbers as text.
import {h} from '../dom.js';
import {bytes, significant} from '../format.js';
import {glyph} from '../plots/palette.js';
import {fewestInterval, fronts, marked, rmsInterval, titleOf} from './model.js';

const mark = '; ~: its 95 % interval is wider than the goal';

const order = (c, name) => c.times?.[`lookup_${name}_order`];

// `text`, `unit`, and value(c): the number, for CSV. show(c): as it is written, significant with `digits` if left out.
const columns = [
  {text: 'build', unit: 'ms', value: (c) => c.times?.build_ms?.median, settled: 'build', title: `One thread, median${mark}`},
  {text: 'image', unit: 'ns', value: (c) => order(c, 'image')?.ns?.median, settled: 'lookup_image_order', title: `One lookup, in image order${mark}`},
  {text: '× floor', of: 'image', value: (c) => order(c, 'image')?.ratio_to_floor?.median, title: 'Relative to reading the same cache lines'},
  {text: 'random', unit: 'ns', value: (c) => order(c, 'random')?.ns?.median, settled: 'lookup_random_order', title: `One lookup, in random order${mark}`},
  {text: '× floor', of: 'random', value: (c) => order(c, 'random')?.ratio_to_floor?.median, title: 'Relative to reading the same cache lines'},
  {text: 'bytes', value: (c) => c.bytes, show: (c) => bytes(c.bytes)},
  {text: 'nodes', unit: 'mean', value: (c) => c.nodes?.mean, title: 'Nodes a cell'},
  {text: 'nodes', unit: 'max', value: (c) => c.nodes?.max},
  {text: 'nodes', unit: '× fewest', value: (c) => c.nodes?.over_fewest?.ratio, title: 'Over the fewest that do within the tolerance without rising', tip: fewestInterval},
  {text: 'curve error', unit: 'max', value: (c) => c.curve_error?.max, digits: 2, title: 'Largest |stored − uncompressed|'},
  {text: 'lookup error', unit: 'RMS', value: (c) => c.lookup_error?.rms, digits: 2, title: 'Relative to the reference', tip: rmsInterval},
  {text: 'lookup', unit: '99 %', value: (c) => c.lookup_error?.p99, digits: 2},
  {text: 'lookup', unit: 'max', value: (c) => c.lookup_error?.max, digits: 2},
];

function shownIn(column, cell) {
  if (column.show) return column.show(cell);
  const text = significant(column.value(cell), column.digits);
  return column.settled ? marked(cell, column.settled, text) : text;
}

// The table as rows, the first with names, with all digits.
export function figures(cells) {
  const name = ({of, text, unit}) => [of, text, unit].filter(Boolean).join(' ').replace('×', 'x');
  return [['technique', ...columns.map(name), 'lookup error RMS, low', 'lookup error RMS, high', ...fronts.map((f) => `front of ${f.text}`), 'verdict'],
    ...cells.map((cell) => [titleOf(cell), ...columns.map((c) => c.value(cell)), ...(cell.lookup_error?.rms_interval95 ?? [null, null]), ...fronts.map((f) => f.of(cell)), cell.verdict ?? cell.status])];
}

const verdicts = {
  kept: '✓', degraded: '△', failed: '✕',
  faster: '✓', smaller: '✓', more_accurate: '✓', slower: '✕', larger: '✕', less_accurate: '✕', missing: '✕', not_comparable: '△',  // verdicts on two results
};

export function verdictMark(cell) {
  const verdict = cell.verdict ?? cell.status, word = verdict.replaceAll(' ', '_');
  return h('span', {class: `verdict verdict-${word}`}, h('span', {'aria-hidden': 'true'}, verdicts[word] ?? '·'), ` ${verdict}`);
}

function frontMarks(cell) {
  return fronts.filter((front) => front.of(cell) !== 'no').map((front) => {
    const open = front.of(cell) === 'perhaps';
    return h('abbr', {class: 'front', title: `${open ? 'Perhaps' : 'Certainly'} on the front of ${front.text}`}, open ? `${front.letter}?` : front.letter);
  });
}

// pick(index) is called for the chosen cell.
export function cellTable({cells, series, chosen, pick}) {
  const head = h('tr', {}, h('th', {scope: 'col'}, 'Technique'),
    columns.map((c) => h('th', {scope: 'col', class: 'number', title: c.title}, c.text, c.unit && h('small', {}, ` ${c.unit}`))),
    h('th', {scope: 'col'}, 'Front'), h('th', {scope: 'col'}, 'Verdict'));
  const rows = cells.map((cell, index) => h('tr', {class: index === chosen ? 'chosen' : null},
    h('th', {scope: 'row'}, h('button', {
      type: 'button', class: 'cell-name', 'data-cell': index, 'aria-pressed': String(index === chosen), onclick: () => pick(index),
    }, h('span', {class: 'index'}, String(index + 1)), glyph(series.get(cell.technique)), h('span', {}, titleOf(cell)))),
    columns.map((c) => h('td', {class: 'number', title: c.tip?.(cell)}, shownIn(c, cell))),
    h('td', {}, frontMarks(cell)), h('td', {}, verdictMark(cell))));
  return h('div', {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Table of techniques'},
    h('table', {class: 'cells'}, h('caption', {class: 'hidden'}, 'Every technique with its times, size, errors and verdict'),
      h('thead', {}, head), h('tbody', {}, rows)));
}
