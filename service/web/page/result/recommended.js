// The answer of a recommendation: what is the cheapest at the error asked for, with a way to go on from there.
import {h} from '../dom.js';
import {seconds, significant} from '../format.js';
import {write} from '../plots/axes.js';
import {glyph} from '../plots/palette.js';
import {costs, settingText} from './settings.js';

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

// A share up to twice as much, a ratio above; as little as half, a ratio below.
function distance(behind) {
  if (behind >= 1 || behind < -0.5) return `${significant(1 + behind, 2)} × as much`;
  return behind >= 0 ? `${significant(100 * behind, 2)} % more` : `${significant(-100 * behind, 2)} % less`;
}

// intervalOf(choice, id): [low, high] of a cost, if it is known.
function nextTo(best, id, intervalOf) {
  const second = best.runner_up;
  if (!second) return null;
  const between = ([low, high]) => `${write(kindOf(id), low)} to ${write(kindOf(id), high)}`;
  const [ours, its] = second.tie ? [best, second].map((choice) => intervalOf(choice, id)) : [];
  const why = ours && its && (ours[0] !== ours[1] || its[0] !== its[1]) ? ` (95 %: ${between(its)}; of the best ${between(ours)})` : '';
  return h('small', {class: 'tie'}, second.tie ? 'A tie with ' : `${distance(second.behind)}: `, `${second.setting}, ${write(kindOf(id), second[id])}${why}${second.confirmed ? '' : ' (not confirmed)'}`);
}

// The 95 % intervals of the costs of what was confirmed.
function intervalsOf({families, confirmed}) {
  const found = new Map(confirmed.filter((one) => !one.failed).map((one) => [settingText(families[one.family], one.step), one]));
  return (choice, id) => found.get(choice.setting)?.[id]?.interval95 ?? null;
}

// The best and, as a second technique, the runner-up; both get the light rays of the best.
function withRunnerUp({part, runner_up: second}) {
  return second?.part?.techniques ? {...part, techniques: [...part.techniques, ...second.part.techniques]} : part;
}

const longest = 1500;  // seconds that may be asked for

// Most techniques had no time: what would do, as {text, seconds}, or nothing. Earlier versions do not say so themselves.
function tooEarly({answer, goal, end, families}) {
  const open = answer.missed.filter((m) => m.why === 'the budget ended').length, all = new Set(families.map((f) => f.technique)).size;
  const known = answer.too_early ?? (answer.too_early === undefined && end === 'budget' && open > 0 && 2 * open >= all
    ? {budget_seconds: goal.budget_seconds, techniques: all, open, give_seconds: Math.max(300, 60 * Math.ceil(goal.budget_seconds / 30))} : null);
  if (!known) return null;
  return {text: ` ${Number.isFinite(known.budget_seconds) ? seconds(known.budget_seconds) : 'It'} ended before ${known.open} of ${known.techniques} techniques were followed to the error, so cheaper settings are likely.`,
    seconds: Math.min(longest, known.give_seconds), more: !(known.budget_seconds >= longest)};
}

const far = 10;  // times the error: what errs more never came near it

// Why a technique is not in the answer.
function whyMissed({why, error}, goal) {
  if (error === null) return [why, 'not measured'];
  return why === 'already dearer' && error > far * goal.error ? ['does not reach it'] : [why, `closest error ${significant(error)}`];
}

// recommendation: of result.json, with its `answer`. text: the same as the program prints it. take(part): opens the scenario
// with a part of it replaced; askAgain(seconds): asks the same with more time; nothing where nobody can. series: numbers of techniques.
export function recommendedView({recommendation, text, take, askAgain, series}) {
  const {answer, goal, measure} = recommendation, intervalOf = intervalsOf(recommendation), early = tooEarly(recommendation);
  const mapless = new Set(recommendation.families.filter((family) => family.mapless).map((family) => family.technique));
  const row = (term, choice, id, more) => h('div', {}, h('dt', {}, term), h('dd', {}, glyph(series.get(choice.technique) ?? 0), ' ', h('strong', {}, choice.setting), ` ${costText(choice, id, mapless.has(choice.technique))}`,
    more, take && h('p', {class: 'next'}, h('button', {type: 'button', class: 'quiet small', onclick: () => take(withRunnerUp(choice)),
      title: choice.runner_up?.part?.techniques ? `With ${choice.runner_up.setting} beside it, in the same light rays` : null, 'aria-label': `Open the scenario with ${choice.setting}`}, 'Open with these settings'))));
  const rows = answer.cheapest.map((best) => row(titles[best.cost], best, best.cost, [nextTo(best, best.cost, intervalOf),
    best.perhaps && h('small', {class: 'tie'}, `Perhaps ${write(kindOf(best.cost), best.perhaps[best.cost])}, error not confirmed: ${best.perhaps.setting}`)]));
  if (!answer.reached && answer.closest) rows.push(row('No setting reaches it. The closest', answer.closest, 'lookup_ns', null));
  else if (!answer.reached) rows.push(h('div', {}, h('dt', {}, 'Nothing'), h('dd', {}, 'No setting reaches it.')));
  if (answer.without_map) rows.push(row('Without a map', answer.without_map, 'lookup_ns', null));
  const others = [...answer.missed.map((m) => [m.technique, whyMissed(m, goal)]),
    ...answer.broken.map((b) => [b.technique, [`broke a promise at ${b.settings} of ${b.measured} settings`, b.reason]])];
  const notes = [recommendation.steal > stealLimit && `Unsettled: the host of this virtual machine took ${significant(100 * recommendation.steal, 2)} % of the time. Measure again.`, answer.cut && 'The time to confirm ran out: intervals are wider than planned.', recommendation.end === 'budget' && !early && 'The time given ended first: a cheaper setting may be left.', recommendation.end === 'cancelled' && 'It was cancelled: a cheaper setting may be left.'].filter(Boolean);
  return h('section', {class: 'panel answer', 'aria-labelledby': 'recommended-title'},
    h('h2', {id: 'recommended-title'}, `With an error of at most ${significant(goal.error)}`, h('span', {}, ` (${measures[measure] ?? measure}, 95 % confidence)`)),
    early && h('div', {class: 'unsettled'}, h('p', {}, h('strong', {}, 'The time was too short.'), early.text),
      askAgain && early.more && h('p', {}, h('button', {type: 'button', onclick: () => askAgain(early.seconds)}, `Ask again with ${early.seconds % 60 ? seconds(early.seconds) : `${early.seconds / 60} min`}`))),
    h('dl', {class: 'answers'}, rows), notes.map((note) => h('p', {class: 'note'}, note)),
    others.length > 0 && h('details', {}, h('summary', {}, 'What does not reach it'), h('dl', {class: 'facts'}, others.map(([name, why]) => h('div', {}, h('dt', {}, name), h('dd', {}, why.join('; ')))))),
    text && h('details', {}, h('summary', {}, 'As the program prints it'), h('pre', {class: 'answer', tabindex: '0'}, text)));
}
