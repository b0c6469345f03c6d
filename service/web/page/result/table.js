// The cells of a group as a table, which is the legend of the plots and has the same numbers as text.
import {h} from '../dom.js';
import {bytes, significant} from '../format.js';
import {glyph} from '../plots/palette.js';
import {fronts, marked, rmsInterval, titleOf} from './model.js';

const mark = '; ~: its 95 % interval is wider than the goal';

const columns = [
  {text: 'build', unit: 'ms', of: (c) => marked(c, 'build', significant(c.times?.build_ms?.median)), title: `One thread, median${mark}`},
  {text: 'image', unit: 'ns', of: (c) => marked(c, 'lookup_image_order', significant(c.times?.lookup_image_order?.ns?.median)), title: `One lookup, in image order${mark}`},
  {text: '× floor', of: (c) => significant(c.times?.lookup_image_order?.ratio_to_floor?.median), title: 'Relative to reading the same cache lines'},
  {text: 'random', unit: 'ns', of: (c) => marked(c, 'lookup_random_order', significant(c.times?.lookup_random_order?.ns?.median)), title: `One lookup, in random order${mark}`},
  {text: '× floor', of: (c) => significant(c.times?.lookup_random_order?.ratio_to_floor?.median), title: 'Relative to reading the same cache lines'},
  {text: 'bytes', of: (c) => bytes(c.bytes)},
  {text: 'nodes', unit: 'mean', of: (c) => significant(c.nodes?.mean), title: 'Nodes a cell'},
  {text: 'nodes', unit: 'max', of: (c) => significant(c.nodes?.max)},
  {text: 'curve error', unit: 'max', of: (c) => significant(c.curve_error?.max, 2), title: 'Largest |stored − uncompressed|'},
  {text: 'lookup error', unit: 'RMS', of: (c) => significant(c.lookup_error?.rms, 2), title: 'Relative to the reference', tip: rmsInterval},
  {text: 'lookup', unit: '99 %', of: (c) => significant(c.lookup_error?.p99, 2)},
  {text: 'lookup', unit: 'max', of: (c) => significant(c.lookup_error?.max, 2)},
];

const verdicts = {
  kept: '✓', degraded: '△', failed: '✕',
  faster: '✓', smaller: '✓', more_accurate: '✓', slower: '✕', larger: '✕', less_accurate: '✕', missing: '✕', not_comparable: '△',  // verdicts on two results
};

export function verdictMark(cell) {
  const verdict = cell.verdict ?? cell.status;
  return h('span', {class: `verdict verdict-${verdict}`},
    h('span', {'aria-hidden': 'true'}, verdicts[verdict] ?? '·'), ` ${verdict.replaceAll('_', ' ')}`);
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
    columns.map((c) => h('td', {class: 'number', title: c.tip?.(cell)}, c.of(cell))),
    h('td', {}, frontMarks(cell)), h('td', {}, verdictMark(cell))));
  return h('div', {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Table of techniques'},
    h('table', {class: 'cells'}, h('caption', {class: 'hidden'}, 'Every technique with its times, size, errors and verdict'),
      h('thead', {}, head), h('tbody', {}, rows)));
}
