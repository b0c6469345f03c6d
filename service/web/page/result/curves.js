// One pixel of the light's map: its exact visibility function, the function that every technique stores, and their errors.
import {address} from '../address.js';
import {announce, choice, download, h} from '../dom.js';
import {csvOf, plural, significant} from '../format.js';
import {linearAxis} from '../plots/axes.js';
import {dashOf, lineSample, lookOf, onThemeChange} from '../plots/palette.js';
import {plot} from '../plots/plot.js';
import {saveButtons} from '../plots/save.js';
import {depthRange} from './depth.js';
import {channelOf, differenceOf, thinned, verticesOf} from './functions.js';
import {throughLegend} from './legend.js';
import {lightMapOf, titleOf, worstPixelOf} from './model.js';
import {pixelGrid} from './pixels.js';

const colours = ['red', 'green', 'blue'];
const finest = 1e-3;  // of a plot's height: less than a pixel
const surveySide = 24;  // pixels per side that a survey requests

// The transmittance of the whole pixel, one value per channel.
function through({exact}) {
  return (exact.channels ?? [exact.v]).map((v) => (v.length ? v.at(-1) : 1));
}

function spoken(answer) {
  const mean = through(answer).reduce((sum, v, _, all) => sum + v / all.length, 0);
  return `Pixel ${answer.x}, ${answer.y}: ${significant(100 * mean, 2)} % of the light passes`;
}

// Sends one request at a time; of those that wait only the newest is sent.
function questions(source, group, signal) {
  const known = new Map();
  let next = null, busy = false;
  const key = (x, y) => `${x},${y}`;
  async function fetchOne(x, y) {
    if (!known.has(key(x, y))) known.set(key(x, y), await source.curves(group, x, y, signal));
    return known.get(key(x, y));
  }
  async function run() {
    busy = true;
    while (next && !signal.aborted) {
      const {x, y, done, failed} = next;
      next = null;
      try {
        const answer = await fetchOne(x, y);
        if (!signal.aborted) done(answer);
      } catch (error) {
        if (!signal.aborted && !next) failed(error);
      }
    }
    busy = false;
  }
  return {fetchOne, latest(question) { next = question; if (!busy) run(); }};
}

function legendTable(answer, series, {hidden, toggle, title, worst}) {
  const row = (mark, name, nodes, error, check, act) => h('tr', {}, h('th', {scope: 'row'}, check, mark, ` ${name}`),
    h('td', {class: 'number'}, nodes), h('td', {class: 'number'}, error), h('td', {}, act));
  const head = (text) => h('th', {scope: 'col', class: 'number'}, text);
  return h('table', {class: 'curve-legend'},
    h('thead', {}, h('tr', {}, h('th', {scope: 'col'}, 'Function'), head('nodes'), head('largest error'), h('th', {scope: 'col'}, h('span', {class: 'hidden'}, 'Worst pixel')))),
    h('tbody', {},
      row(h('span', {class: 'exact-mark', 'aria-hidden': 'true'}), `exact, of ${plural(answer.rays, 'ray')}`, String(answer.exact.z.length), '0', null, null),
      answer.curves.map((c, number) => c.absent
        ? h('tr', {class: 'absent'}, h('th', {scope: 'row'}, ` ${title(c)}`), h('td', {colspan: '3'}, c.absent))
        : row(lineSample(series.get(c.technique) ?? 0, number), title(c), String(c.nodes), significant(c.error_max, 2),
          h('input', {type: 'checkbox', checked: !hidden.has(c.title), 'aria-label': `Show ${title(c)}`, onchange: () => toggle(c.title)}),
          worst(c) && h('button', {type: 'button', class: 'quiet small', onclick: worst(c), 'aria-label': `Show the worst pixel of ${title(c)}`}, 'worst pixel')))));
}

// All vertices as rows, with all digits.
function tableOf(answer) {
  const rows = [['function', 'channel', 'depth', 'visibility']];
  for (const curve of [{...answer.exact, title: 'exact'}, ...answer.curves.filter((c) => !c.absent)])
    for (let channel = 0; channel < (curve.channels?.length ?? 1); ++channel) {
      const {z, v} = channelOf(curve, channel);
      z.forEach((depth, i) => rows.push([curve.title, channel, depth, v[i]]));
    }
  return rows;
}

// For a source with curves (a running server). images: of this variant, or nothing. worst(cell) shows its worst pixel.
export function curvesView({source, result, images, group, series, signal}) {
  const {width, height, z_min: nearest, z_max: furthest} = group.light.map;
  const picture = lightMapOf(images, group);
  const drawing = plot('curves', {label: 'Visibility functions', signal}), errors = plot('strip', {label: 'Errors of the functions', signal});
  const legend = h('div', {class: 'scroll'}), heading = h('p', {class: 'axis-title curve-title'}, '↑ visibility');
  const problem = h('p', {class: 'note problem', role: 'alert'});
  const asked = questions(source, group, signal);
  const hidden = new Set();
  let shown = null, surveying = false, channel = Math.max(0, colours.indexOf(address.get('channel'))), chosen = null, waiting = 0;

  function draw() {
    waiting = 0;
    if (!shown || signal.aborted) return;
    const [low, high] = depth.range(), whole = [shown.z_min, shown.z_max];
    const exactCurve = channelOf(shown.exact, channel);
    const vertices = thinned(verticesOf('exact', exactCurve, ...whole, {colour: drawing.colour('exact'), dash: [1, 0], width: 7}), finest), errorsOf = [];
    shown.curves.forEach((c, number) => {
      if (c.absent || hidden.has(c.title)) return;
      const look = {colour: lookOf(series.get(c.technique) ?? 0).colour, dash: dashOf(number), width: 1.8}, curve = channelOf(c, channel);
      vertices.push(...thinned(verticesOf(c.title, curve, ...whole, look), finest));
      errorsOf.push(differenceOf(curve, exactCurve, ...whole).map(([z, v], order) => ({curve: c.title, order, z, v, ...look})));
    });
    channels.hidden = !shown.exact.channels;
    const ends = (values, least) => [Math.min(-least, ...values), Math.max(least, ...values)];
    const [bottom, top] = [Math.min(0, ...vertices.map((p) => p.v)), Math.max(1, ...vertices.map((p) => p.v))];
    const [below, above] = ends(errorsOf.flat().map((p) => p.v), 1e-3), x = linearAxis('x', low, high, 7);
    drawing.update({
      signals: {...x, ...linearAxis('y', bottom - 0.02, top + 0.02, 5)},
      data: {vertices},
      description: `Visibility against depth at pixel ${shown.x}, ${shown.y}: ` +
        shown.curves.map((c) => `${c.title} ${c.absent ?? `${c.nodes} nodes, largest error ${significant(c.error_max, 2)}`}`).join('; '),
    });
    errors.update({signals: {...x, ...linearAxis('y', 1.08 * below, 1.08 * above, 4, (v) => significant(v, 2))}, data: {vertices: errorsOf.flatMap((one) => thinned(one, finest * (above - below)))},
      description: `Stored minus exact visibility against depth at pixel ${shown.x}, ${shown.y}, from ${significant(below, 2)} to ${significant(above, 2)}`});
    heading.textContent = `↑ visibility at pixel ${shown.x}, ${shown.y}`;
    legend.replaceChildren(legendTable(shown, series, {
      hidden,
      toggle(title) {
        hidden.has(title) ? hidden.delete(title) : hidden.add(title);
        draw();
      },
      title: (c) => (cellOf(c) ? titleOf(cellOf(c)) : c.title),
      worst(c) {
        const found = worsts.find((w) => w.cell === cellOf(c));
        return found && (() => choose(...found.at));
      },
    }));
  }
  // The server names a function by what differs from the defaults.
  const cellOf = (c) => group.cells.find((cell) => cell.technique === c.technique && [cell.technique, cell.label].filter(Boolean).join(' ') === c.title);
  const redraw = () => { waiting ||= requestAnimationFrame(draw); };

  function show(x, y, speak) {
    asked.latest({
      x, y,
      done(answer) {
        shown = answer;
        problem.textContent = '';
        xInput.value = answer.x;
        yInput.value = answer.y;
        grid.mark(answer.x, answer.y);
        grid.fill(answer.x, answer.y, 1, 1, through(answer));
        redraw();
        if (speak) announce(spoken(answer));
      },
      failed(error) { problem.textContent = error.message; },
    });
  }
  // A pixel that stays.
  function choose(x, y, moves = false) {
    chosen = [x, y];
    address[moves ? 'keep' : 'go']({pixel: `${x},${y}`});
    show(x, y, true);
  }
  const worst = (cell) => {
    choose(...worstPixelOf(cell, group.light.map));
    element.scrollIntoView({block: 'nearest', behavior: 'smooth'});
  };

  const channels = choice('Channel', colours.map((text, value) => ({value, text})), channel, (v) => { channel = Number(v); address.go({channel: colours[channel]}); draw(); });
  channels.hidden = true;
  const depth = depthRange({places: [drawing.element, errors.element], nearest, furthest, start: address.numbers('depth', 2),
    moved(range) { address.keep({depth: range && range.map((v) => Number(v.toPrecision(5))).join(',')}); redraw(); }});
  const up = !result.scenario?.scene?.deep_image;  // the rows of a deep image go downwards
  const grid = pixelGrid({name: `Map of light ${group.light.light}`, width, height, up, ask: (x, y) => show(x, y, false),
    leave() { if (chosen) show(...chosen, false); }, choose});
  const field = (label, most) => h('input', {type: 'number', min: '0', max: String(most - 1), step: '1', value: String(Math.floor(most / 2)), 'aria-label': label});
  const xInput = field('x', width), yInput = field('y', height);
  const entered = (event) => {
    event.preventDefault();
    if (xInput.reportValidity() && yInput.reportValidity()) choose(Number(xInput.value), Number(yInput.value));
  };
  const worsts = group.cells.map((cell) => ({cell, at: worstPixelOf(cell, group.light.map)})).filter((w) => w.at && w.cell.curve_error.max > 0);

  async function survey() {
    if (surveying) { surveying = false; return; }
    surveying = true;
    surveyButton.textContent = 'Stop';
    const side = Math.max(1, Math.ceil(Math.max(width, height) / surveySide));
    try {
      for (let y = 0; y < height && surveying && !signal.aborted; y += side)
        for (let x = 0; x < width && surveying && !signal.aborted; x += side) {
          const w = Math.min(side, width - x), h_ = Math.min(side, height - y);
          grid.fill(x, y, w, h_, through(await asked.fetchOne(x + (w >> 1), y + (h_ >> 1))));
        }
    } catch (error) {
      if (!signal.aborted) problem.textContent = error.message;
    }
    surveying = false;
    surveyButton.textContent = 'Survey';
  }
  const surveyButton = h('button', {type: 'button', class: 'quiet', title: 'Reads pixels all over the map', onclick: survey}, 'Survey');

  surveyButton.hidden = picture !== null;
  if (picture) source.picture(picture, signal).then(grid.show, () => { surveyButton.hidden = false; });

  onThemeChange(() => { if (shown) draw(); }, signal);
  // The rays of a pixel explain the error of a function per pixel.
  const start = worsts.find((w) => w.cell.nodes?.cells === width * height) ?? worsts[0];
  const asks = address.numbers('pixel', 2)?.map((v, i) => Math.max(0, Math.min([width, height][i] - 1, Math.floor(v))));
  chosen = asks ?? start?.at ?? [Math.floor(width / 2), Math.floor(height / 2)];
  show(...chosen, false);

  const name = () => `${result.name ?? 'result'}.pixel-${shown?.x}-${shown?.y}`, figure = h('div', {}, drawing.element);
  const strip = h('div', {}, errors.element), across = 'depth from the light, as the scene measures length →';
  const csv = () => { if (shown) download(`${name()}.csv`, 'text/csv', csvOf(tableOf(shown))); };
  const element = h('section', {class: 'panel', id: 'curves', 'aria-labelledby': 'curves-title'},
    h('div', {class: 'panel-head'}, h('h2', {id: 'curves-title'}, 'Visibility functions'), h('div', {class: 'choices'}, channels, depth.element)),
    h('div', {class: 'pixels'},
      h('figure', {}, h('figcaption', {class: 'axis-title'}, `map of light ${group.light.light}${up ? ', as the light sees it' : ''}: ${width} × ${height} pixels, (0, 0) at the ${up ? 'lower' : 'upper'} left`),
        grid.element, throughLegend(),
        h('form', {class: 'pixel-entry', onsubmit: entered},
          h('label', {}, 'x ', xInput), h('label', {}, 'y ', yInput), h('button', {type: 'submit', class: 'quiet'}, 'Show'), surveyButton),
        h('p', {class: 'note'}, picture ? 'Point at a pixel, move to it with the arrow keys, or enter it. A click keeps it.'
          : 'There is no picture of this map: pixels are painted as they are read. Point at one, move to it with the arrow keys, or enter it. Survey reads pixels all over the map.'), problem),
      h('figure', {},
        h('div', {class: 'figure-head'}, heading, h('span', {class: 'save'}, saveButtons(figure, name, () => ({title: name(), up: heading.textContent, across})),
          h('button', {type: 'button', class: 'quiet small', onclick: csv, 'aria-label': 'Save the functions as CSV'}, 'CSV'))),
        figure, h('p', {class: 'axis-title'}, '↑ error: stored − exact'), strip, h('p', {class: 'axis-title across'}, across), legend)));
  return {element, worst};
}
