// A recommendation as a page shows it, before the settings that were measured for it.
import {h} from '../dom.js';
import {numberOf} from '../plots/numbers.js';
import {exploredView} from './explored.js';
import {seriesOf} from './model.js';
import {recommendedView} from './recommended.js';

// The rays of a recommendation's first answer, as settings of a variant.
function firstOf({recommendation}) {
  const {answer} = recommendation ?? {}, rays = (answer?.cheapest[0] ?? answer?.closest)?.part.rays ?? {};
  return Object.fromEntries(Object.entries(rays).map(([name, value]) => [`/rays/${name}`, value]));
}

// The same as the error of a run that is allowed.
function askedOf({goal, measure}) {
  return {budget: goal.error, error: measure === 'curve' ? 'curve.max' : `lookup.${measure}`};
}

// What the view of its result shows at first: the variant of its answer, at the error that was asked for.
export function shownFirst(result) {
  return {first: firstOf(result), asked: result.recommendation ? askedOf(result.recommendation) : null};
}

// The answer, and what was measured for it; nothing of another result. Results of earlier versions have the answer as text
// only. take, askAgain: as of recommendedView(), absent where there is no server.
export function recommendationParts({result, text, name, take, askAgain, signal}) {
  const {recommendation} = result;
  if (!recommendation) return [];
  const series = seriesOf(result);
  for (const {technique} of recommendation.families) series.set(technique, numberOf(technique));
  return [
    recommendation.answer ? recommendedView({recommendation, text, take, askAgain, series})
      : text && h('section', {class: 'panel', 'aria-label': 'Recommendation'}, h('h2', {}, 'Recommendation'), h('pre', {class: 'answer', tabindex: '0'}, text)),
    exploredView({recommendation, series, name, signal}),
    h('div', {}, h('h2', {}, 'The settings measured, by resolution and rays a pixel'), h('p', {class: 'note'}, 'Each was measured once and briefly. The answer above rests on what was confirmed.')),
  ].filter(Boolean);
}
