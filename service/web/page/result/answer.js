// The answer of a group in words: what to take at an error that is allowed.
import {h} from '../dom.js';
import {significant} from '../format.js';
import {write} from '../plots/axes.js';
import {glyph} from '../plots/palette.js';
import {answersAt} from './answers.js';
import {size, titleOf} from './model.js';

const joined = (parts) => parts.filter(Boolean).join(', ');

// among: of the settings that a recommendation measured, whose answer stands above. pick(index), allow(value, last): as for the plots. update({cells, series, error, speed, budget}).
export function answerView({among, pick, allow}) {
  const list = h('dl', {class: 'answers', 'aria-live': 'polite'}), measure = h('span');
  const field = h('input', {type: 'number', min: '0', step: 'any', id: 'budget', onchange: () => { if (field.value !== '' && Number(field.value) > 0) allow(Number(field.value), true); }});
  const element = h('section', {class: 'panel answer', 'aria-labelledby': 'answer-title'},
    h('h2', {id: 'answer-title'}, h('label', {for: 'budget'}, among ? 'Among the settings measured, with an error of at most ' : 'With an error of at most '), field, measure), list);

  function update({cells, series, error, speed, budget}) {
    const found = answersAt(cells, {error, speed, budget});
    const name = (cell) => h('button', {type: 'button', class: 'link', onclick: () => pick(cells.indexOf(cell))}, titleOf(cell));
    const costs = (cell, more = '') => h('span', {}, ' ', joined([speed.of(cell) && `${write(speed.kind, speed.of(cell).value)}${speed.kind === 'ratio' ? ' the floor' : ''}`, size.of(cell) && write('bytes', size.of(cell).value), `error ${significant(error.of(cell).value, 2)}`]), more);
    const row = (term, cell, more, rest) => h('div', {}, h('dt', {}, term), h('dd', {}, glyph(series.get(cell.technique)), ' ', name(cell), costs(cell, more), rest));
    const {fastest, smallest, rivals, traced, closest} = found, rows = [], first = speed.id === 'build' ? 'Fastest build' : 'Fastest';
    if (smallest) {
      const same = fastest === smallest;
      const tie = rivals.length > 0 && h('small', {class: 'tie'}, ' Perhaps as fast: ', rivals.map((cell, i) => [i > 0 && ', ', name(cell)]), '.');
      if (fastest) rows.push(row(same ? `${first} and smallest` : first, fastest, '', tie));
      const share = fastest && size.of(smallest).value / size.of(fastest).value, slower = fastest && speed.of(smallest) && speed.of(smallest).value / speed.of(fastest).value;
      if (!same) rows.push(row('Smallest', smallest, joined([share && `; ${significant(share, 2)} × the bytes`, slower && `${significant(slower, 2)} × the time`])));
      if (!found.certain) rows.push(h('div', {}, h('dt', {}, 'Perhaps'), h('dd', {}, 'The intervals of these errors reach beyond it.')));
    } else if (closest) rows.push(row('No map reaches it. The closest', closest, ''));
    else rows.push(h('div', {}, h('dt', {}, 'Nothing'), h('dd', {}, 'No map has this error.')));
    if (traced) rows.push(row('Without a map', traced, ''));
    list.replaceChildren(...rows);
    measure.textContent = ` (${error.text})`;
    const text = String(Number(budget.toPrecision(3)));
    if (document.activeElement !== field || Number(field.value) !== Number(text)) field.value = text;
  }
  return {element, update};
}
