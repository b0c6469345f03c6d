// The answer of a recommendation: what is the cheapest at the error asked for, with a way to go on from there.
import {h} from '../dom.js';
import {significant} from '../format.js';
import {write} from '../plots/axes.js';
import {glyph} from '../plots/palette.js';
import {costs} from './settings.js';

const titles = {lookup_ns: 'Fastest lookup', bytes: 'Fewest bytes', build_ms: 'Fastest build'};
export const measures = {rms: 'RMS', max: 'the largest', p99: '99th percentile', curve: 'the largest of the functions'};
const units = {lookup_ns: ' a lookup', bytes: '', build_ms: ' to build'};
const stealLimit = 0.02;  // as the program's
const kindOf = (id) => costs.find((c) => c.id === id).kind;

function errorText({confirmed, error: [low, high]}) {
  return confirmed ? `error ${significant(low)} to ${significant(high)}` : `error about ${significant(high)}, not confirmed`;
}

// What a setting costs; without a map it has no bytes and no build.
function costText(choice, first, mapless) {
  const ids = [first, ...costs.map((c) => c.id).filter((id) => id !== first)].filter((id) => !(mapless && id !== 'lookup_ns'));
  return [...ids.map((id) => write(kindOf(id), choice[id]) + units[id]), errorText(choice)].join(', ');
}

function nextTo(best, id) {
  const second = best.runner_up;
  if (!second) return null;
  const behind = second.tie ? 'A tie with' : second.behind >= 0 ? `${significant(100 * second.behind, 2)} % more` : `${significant(-100 * second.behind, 2)} % less`;
  return h('small', {class: 'tie'}, second.tie ? `${behind} ` : `${behind}: `, `${second.setting}, ${write(kindOf(id), second[id])}${second.confirmed ? '' : ' (not confirmed)'}`);
}

// recommendation: of result.json, with its `answer`. text: the same as the program prints it. take(part): opens the scenario
// with a part of it replaced; nothing where nobody can. series: numbers of techniques.
export function recommendedView({recommendation, text, take, series}) {
  const {answer, goal, measure} = recommendation;
  const mapless = new Set(recommendation.families.filter((family) => family.mapless).map((family) => family.technique));
  const row = (term, choice, id, more) => h('div', {}, h('dt', {}, term), h('dd', {}, glyph(series.get(choice.technique) ?? 0), ' ', h('strong', {}, choice.setting), ` ${costText(choice, id, mapless.has(choice.technique))}`,
    more, take && h('p', {class: 'next'}, h('button', {type: 'button', class: 'quiet small', onclick: () => take(choice.part), 'aria-label': `Run the scenario with ${choice.setting}`}, 'Run with these settings'))));
  const rows = answer.cheapest.map((best) => row(titles[best.cost], best, best.cost, [nextTo(best, best.cost),
    best.perhaps && h('small', {class: 'tie'}, `Perhaps ${write(kindOf(best.cost), best.perhaps[best.cost])}, error not confirmed: ${best.perhaps.setting}`)]));
  if (!answer.reached && answer.closest) rows.push(row('No setting reaches it. The closest', answer.closest, 'lookup_ns', null));
  else if (!answer.reached) rows.push(h('div', {}, h('dt', {}, 'Nothing'), h('dd', {}, 'No setting reaches it.')));
  if (answer.without_map) rows.push(row('Without a map', answer.without_map, 'lookup_ns', null));
  const others = [...answer.missed.map((m) => [m.technique, [m.why, m.error === null ? 'not measured' : `closest error ${significant(m.error)}`]]),
    ...answer.broken.map((b) => [b.technique, [`broke a promise at ${b.settings} of ${b.measured} settings`, b.reason]])];
  const notes = [recommendation.steal > stealLimit && `Unsettled: the host of this virtual machine took ${significant(100 * recommendation.steal, 2)} % of the time. Measure again.`, answer.cut && 'The time to confirm ran out: intervals are wider than planned.', recommendation.end === 'budget' && 'The time given ended first: a cheaper setting may be left.', recommendation.end === 'cancelled' && 'It was cancelled: a cheaper setting may be left.'].filter(Boolean);
  return h('section', {class: 'panel answer', 'aria-labelledby': 'recommended-title'},
    h('h2', {id: 'recommended-title'}, `With an error of at most ${significant(goal.error)}`, h('span', {}, ` (${measures[measure] ?? measure}, 95 % confidence)`)),
    h('dl', {class: 'answers'}, rows), notes.map((note) => h('p', {class: 'note'}, note)),
    others.length > 0 && h('details', {}, h('summary', {}, 'What does not reach it'), h('dl', {class: 'facts'}, others.map(([name, why]) => h('div', {}, h('dt', {}, name), h('dd', {}, why.join('; ')))))),
    text && h('details', {}, h('summary', {}, 'As the program prints it'), h('pre', {class: 'answer', tabindex: '0'}, text)));
}
