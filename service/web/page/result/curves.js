// One pixel of the light's map: its exact visibility function, and the function that every technique stores.
import {choice, h, announce} from '../dom.js';
import {plural, significant} from '../format.js';
import {linearAxis} from '../plots/axes.js';
import {dashOf, lineSample, lookOf, onThemeChange} from '../plots/palette.js';
import {plot} from '../plots/plot.js';
import {throughLegend} from './legend.js';
import {lightMapOf, titleOf, worstPixelOf} from './model.js';
import {pixelGrid} from './pixels.js';

const hoverPause = 60;  // milliseconds
const surveySide = 24;  // pixels per side that a survey requests

// The vertices of one function over the whole depth range: its first value before, its last value after.
function verticesOf(curve, {z, v}, low, high, look) {
  const first = v.length ? v[0] : 1, last = v.length ? v.at(-1) : 1;
  return [[low, first], ...z.map((depth, i) => [depth, v[i]]), [high, last]]
    .map(([depth, value], order) => ({curve, order, z: depth, v: value, ...look}));
}

// One channel of a function. In a coloured map each channel may have its own depths.
function channelOf(curve, channel) {
  return {z: curve.channels_z?.[channel] ?? curve.z, v: curve.channels?.[channel] ?? curve.v};
}

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
        if (!next) done(answer);
      } catch (error) {
        if (!signal.aborted && !next) failed(error);
      }
    }
    busy = false;
  }
  return {fetchOne, latest(question) { next = question; if (!busy) run(); }};
}

function legendTable(answer, series, hidden, toggle) {
  const row = (mark, title, nodes, error, check) => h('tr', {}, h('th', {scope: 'row'}, check, mark, ` ${title}`),
    h('td', {class: 'number'}, nodes), h('td', {class: 'number'}, error));
  return h('table', {class: 'curve-legend'},
    h('thead', {}, h('tr', {}, h('th', {scope: 'col'}, 'Function'), h('th', {scope: 'col', class: 'number'}, 'nodes'), h('th', {scope: 'col', class: 'number'}, 'largest error'))),
    h('tbody', {},
      row(h('span', {class: 'exact-mark', 'aria-hidden': 'true'}), `exact, of ${plural(answer.rays, 'ray')}`, String(answer.exact.z.length), '0', null),
      answer.curves.map((c, number) => c.absent
        ? h('tr', {class: 'absent'}, h('th', {scope: 'row'}, ` ${c.title}`), h('td', {colspan: '2'}, c.absent))
        : row(lineSample(series.get(c.technique) ?? 0, number), c.title, String(c.nodes), significant(c.error_max, 2),
          h('input', {type: 'checkbox', checked: !hidden.has(c.title), 'aria-label': `Show ${c.title}`, onchange: () => toggle(c.title)})))));
}

// For a source with curves (a running server). images: of this variant, or nothing.
export function curvesView({source, result, images, group, series, signal}) {
  const {width, height} = group.light.map;
  const picture = lightMapOf(images, group);
  const drawing = plot('curves', {label: 'Visibility functions', signal});
  const legend = h('div', {class: 'scroll'}), heading = h('p', {class: 'axis-title curve-title'}, '↑ visibility');
  const problem = h('p', {class: 'note problem', role: 'alert'});
  const asked = questions(source, group, signal);
  const hidden = new Set();
  let shown = null, timer = 0, surveying = false, channel = 0;

  function draw() {
    const {z_min: low, z_max: high} = shown;
    const exact = {colour: drawing.colour('exact'), dash: [1, 0], width: 7};
    const vertices = verticesOf('exact', channelOf(shown.exact, channel), low, high, exact);
    shown.curves.forEach((c, number) => {
      if (c.absent || hidden.has(c.title)) return;
      const {colour} = lookOf(series.get(c.technique) ?? 0);
      vertices.push(...verticesOf(c.title, channelOf(c, channel), low, high, {colour, dash: dashOf(number), width: 1.8}));
    });
    channels.hidden = !shown.exact.channels;
    const values = vertices.map((p) => p.v);
    const bottom = Math.min(0, ...values), top = Math.max(1, ...values);
    drawing.update({
      signals: {...linearAxis('x', low, high, 7), ...linearAxis('y', bottom - 0.02, top + 0.02, 5)},
      data: {vertices},
      description: `Visibility against depth at pixel ${shown.x}, ${shown.y}: ` +
        shown.curves.map((c) => `${c.title} ${c.absent ?? `${c.nodes} nodes, largest error ${significant(c.error_max, 2)}`}`).join('; '),
    });
    heading.textContent = `↑ visibility at pixel ${shown.x}, ${shown.y}`;
    legend.replaceChildren(legendTable(shown, series, hidden, (title) => {
      hidden.has(title) ? hidden.delete(title) : hidden.add(title);
      draw();
    }));
  }

  function show(x, y, speak) {
    asked.latest({
      x, y,
      done(answer) {
        shown = answer;
        problem.textContent = '';
        xInput.value = x;
        yInput.value = y;
        grid.mark(x, y);
        grid.fill(x, y, 1, 1, through(answer));
        draw();
        if (speak) announce(spoken(answer));
      },
      failed(error) { problem.textContent = error.message; },
    });
  }

  const channels = choice('Channel', ['red', 'green', 'blue'].map((text, value) => ({value, text})), 0, (v) => { channel = Number(v); draw(); });
  channels.hidden = true;
  const hover = (x, y) => { clearTimeout(timer); timer = setTimeout(() => show(x, y, false), hoverPause); };
  const up = !result.scenario?.scene?.deep_image;  // the rows of a deep image go downwards
  const grid = pixelGrid({name: `Map of light ${group.light.light}`, width, height, up, ask: hover, choose: (x, y) => show(x, y, true)});
  const field = (label, most) => h('input', {type: 'number', min: '0', max: String(most - 1), step: '1', value: String(Math.floor(most / 2)), 'aria-label': label});
  const xInput = field('x', width), yInput = field('y', height);
  const entered = (event) => {
    event.preventDefault();
    if (xInput.reportValidity() && yInput.reportValidity()) show(Number(xInput.value), Number(yInput.value), true);
  };
  const worst = group.cells.map((cell, i) => ({cell, text: `${i + 1}  ${titleOf(cell)}`, at: worstPixelOf(cell, group.light.map)}))
    .filter((w) => w.at && w.cell.curve_error.max > 0);

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
  signal.addEventListener('abort', () => clearTimeout(timer), {once: true});
  // The rays of a pixel explain the error of a function per pixel.
  const start = worst.find((w) => w.cell.nodes?.cells === width * height) ?? worst[0];
  show(...start?.at ?? [Math.floor(width / 2), Math.floor(height / 2)], false);

  return h('section', {class: 'panel', id: 'curves', 'aria-labelledby': 'curves-title'},
    h('div', {class: 'panel-head'}, h('h2', {id: 'curves-title'}, 'Visibility functions'),
      h('div', {class: 'choices'}, channels, worst.length > 0 && choice('Worst pixel of', [{value: '', text: '…'}, ...worst.map((w, i) => ({value: i, text: w.text}))], '',
        (i) => { if (i !== '') show(...worst[i].at, true); }))),
    h('div', {class: 'pixels'},
      h('figure', {}, h('figcaption', {class: 'axis-title'}, `map of light ${group.light.light}${up ? ', as the light sees it' : ''}: ${width} × ${height} pixels, (0, 0) at the ${up ? 'lower' : 'upper'} left`),
        grid.element, throughLegend(),
        h('form', {class: 'pixel-entry', onsubmit: entered},
          h('label', {}, 'x ', xInput), h('label', {}, 'y ', yInput), h('button', {type: 'submit', class: 'quiet'}, 'Show'), surveyButton),
        h('p', {class: 'note'}, picture ? 'Point at a pixel, move to it with the arrow keys, or enter it.'
          : 'There is no picture of this map: pixels are painted as they are read. Point at one, move to it with the arrow keys, or enter it. Survey reads pixels all over the map.'), problem),
      h('figure', {}, heading, drawing.element, h('p', {class: 'axis-title'}, 'depth from the light, as the scene measures length →'), legend)));
}
