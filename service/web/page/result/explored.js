// A plot of what a recommendation measured.
import {address} from '../address.js';
import {choice, h, setText} from '../dom.js';
import {significant} from '../format.js';
import {logAxis, logPlace, write} from '../plots/axes.js';
import {labelFields, placeLabels} from '../plots/labels.js';
import {glyph, levelSample, lookOf, onThemeChange} from '../plots/palette.js';
import {labelWidth, plot} from '../plots/plot.js';
import {saveButtons} from '../plots/save.js';
import {frontOf} from './model.js';
import {measures} from './recommended.js';
import {costs, labelsOf, ownFronts, pointsAt, settingsOf} from './settings.js';

// series: numbers of techniques.
export function exploredView({recommendation, series, name, signal}) {
  const settings = settingsOf(recommendation), techniques = [...new Set(recommendation.families.map((f) => f.technique))];
  const goal = recommendation.goal.error;
  const drawing = plot('trade', {label: 'Settings that were measured', signal,
    theme: () => ({ink: drawing.colour('ink'), muted: drawing.colour('muted'), paper: drawing.colour('panel'), shade: drawing.colour('grid')})});
  const place = h('div', {class: 'plot-place'}, drawing.element), legend = h('ul', {class: 'levels'}), up = h('p', {class: 'axis-title'}), across = h('p', {class: 'axis-title across'});
  const picker = choice('Cost', costs.map((c) => ({value: c.id, text: c.text})), '', (id) => { address.go({cost: id}); draw(); });
  function draw() {
    const cost = costs.find((c) => c.id === address.get('cost')) ?? costs[0];
    picker.querySelector('select').value = cost.id;
    const points = pointsAt(settings, cost);
    const x = logAxis('x', points.flatMap((p) => [p.x, p.xLow, p.xHigh]), cost.kind).signals, y = logAxis('y', [...points.flatMap((p) => [p.y, p.low, p.high]), goal].filter((v) => v > 0), 'error').signals;
    // Named are the settings that are confirmed and, of techniques without such, the one that errs least.
    const own = (t) => points.filter((p) => p.technique === t);
    const firsts = new Set(techniques.filter((t) => !own(t).some((p) => p.confirmed)).map((t) => frontOf(own(t)).at(-1)));
    const drawn = points.map((p, key) => {
      const {colour, shape} = lookOf(series.get(p.technique));
      return {key, technique: p.technique, words: p.words, x: p.x, low: p.xLow, high: p.xHigh, y: p.y, yLow: p.low || p.y, yHigh: p.high || p.y, colour, shape, chosen: false,
        fill: p.confirmed ? colour : drawing.colour('panel'), size: p.confirmed ? 150 : 45, labelled: firsts.has(p) || p.confirmed,
        tip: `${p.name}\n${cost.text}: ${write(cost.kind, p.x)}\nerror: ${significant(p.y)}${p.confirmed ? `, 95 %: ${significant(p.low)} to ${significant(p.high)}` : ', measured once'}`};
    });
    const labelled = (width, height) => {
      const at = (p) => ({x: width * logPlace('x', x, p.x), y: height * (1 - logPlace('y', y, p.y))});
      const named = drawn.filter((p) => p.labelled), names = labelsOf(named);
      const marks = drawn.filter((p) => !p.labelled).map((p) => ({...at(p), radius: 5, texts: ['']}));
      const placed = placeLabels({lines: [], width, height, widthOf: labelWidth, furthest: 22, points: [...named.map((p, i) => ({...at(p), radius: 8, texts: [names[i], ''], first: p.confirmed})), ...marks]});
      const labels = new Map(named.map((p, i) => [p.key, placed[i]]));
      return drawn.map((p) => ({...p, ...labelFields(labels.get(p.key) ?? {text: '', dx: 0, dy: 0, lead: null})}));
    };
    setText(up, `↑ error, ${measures[recommendation.measure] ?? recommendation.measure}`);
    setText(across, `${cost.text} →`);
    legend.replaceChildren(h('li', {}, levelSample([6, 3]), ` the error asked for: ${significant(goal)}`),
      ...techniques.filter((t) => points.some((p) => p.technique === t)).map((t) => h('li', {}, glyph(series.get(t)), ` ${t}`)));
    const lines = ownFronts(points).map((p) => ({...p, colour: lookOf(series.get(p.technique)).colour}));
    drawing.update({
      signals: {...x, ...y}, data: (width, height) => ({points: labelled(width, height), front: [], band: [], lines, levels: [{y: goal, dash: [6, 3]}]}),
      description: `${points.length} settings of ${techniques.length} techniques: ${cost.text} against error, log axes; the error asked for is ${significant(goal)}.`,
    });
  }
  if (!settings.length)
    return h('section', {class: 'panel', id: 'explored', 'aria-labelledby': 'explored-title'}, h('h2', {id: 'explored-title'}, 'What was measured'), h('p', {class: 'note'}, 'No setting was measured that kept its promises.'));
  draw();
  onThemeChange(draw, signal);
  addEventListener('hashchange', draw, {signal});
  return h('section', {class: 'panel', id: 'explored', 'aria-labelledby': 'explored-title'},
    h('div', {class: 'panel-head'}, h('h2', {id: 'explored-title'}, 'What was measured'),
      h('div', {class: 'choices'}, picker, saveButtons(place, () => `${name}.explored`, () => ({title: `${name}: settings measured`, up: up.textContent, across: across.textContent})))),
    up, place, across, legend,
    h('p', {class: 'note'}, 'Full marks are confirmed, with 95 % intervals; open ones were measured once. Lines join the settings of a technique that no other of its own beats.'));
}
