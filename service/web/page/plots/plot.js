// Shows a compiled plot on the page, with the parts of Vega that the plots need. Vega's compiler of expressions is left out:
// it evaluates strings, which the page's Content-Security-Policy forbids.
import {changeset, transforms} from 'vega-dataflow';
import * as encoders from 'vega-encode';
import {expressionInterpreter} from 'vega-interpreter';
import {parse} from 'vega-parser';
import * as dataTransforms from 'vega-transforms';
import {View} from 'vega-view';
import * as viewTransforms from 'vega-view-transforms';
import compiled from 'compiled-plots';
import {h} from '../dom.js';
import {onThemeChange} from './palette.js';

Object.assign(transforms, dataTransforms, viewTransforms, encoders);

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

function config() {
  const font = getComputedStyle(document.body).fontFamily;
  const label = colour('muted'), line = colour('line'), grid = colour('grid');
  return {
    background: null, font, style: {cell: {stroke: 'transparent'}},
    axis: {
      domainColor: line, tickColor: line, gridColor: grid, labelColor: label, labelFontSize: 11, tickSize: 4,
      labelFont: font, grid: true, domain: true, gridWidth: 1, labelPadding: 5,
    },
  };
}

let pen = null;

// The width of a label in pixels: bold, of 11 pixels, as specs.js has it.
export function labelWidth(text) {
  pen ??= document.createElement('canvas').getContext('2d');
  pen.font = `600 11px ${getComputedStyle(document.body).fontFamily}`;
  return pen.measureText(text).width;
}

function tooltipOver(box) {
  return (_, event, item, value) => {
    const text = value === null || value === undefined ? '' : String(value);
    box.hidden = text === '';
    if (text === '') return;
    box.textContent = text;
    const place = box.parentElement.getBoundingClientRect();
    const x = event.clientX - place.left, y = event.clientY - place.top;
    box.style.left = `${Math.max(0, Math.min(x + 14, place.width - box.offsetWidth - 4))}px`;
    box.style.top = `${Math.max(0, y - box.offsetHeight - 12)}px`;
  };
}

// name: a key of specs.js. update({signals, data, description}) draws it again; data may be a function of the width and
// height in pixels. theme() gives the signals that are colours; it is called whenever the theme changes. onPick(datum) is called for clicks on marks named "points".
// onFrame({left, top, width, height}) is called with the place of the data in the element, whenever it may have changed.
export function plot(name, {onPick, onFrame, theme = () => ({}), label, signal}) {
  const canvas = h('div', {class: 'plot-canvas'});
  const box = h('div', {class: 'tooltip', hidden: true});
  const element = h('div', {class: 'plot', role: 'img', 'aria-label': label}, canvas, box);
  let view = null, state = {signals: {}, data: {}}, width = 0;

  function apply() {
    for (const [key, value] of Object.entries({...state.signals, ...theme()})) view.signal(key, value);
    const data = typeof state.data === 'function' ? state.data(view.width(), view.height()) : state.data;
    for (const [key, rows] of Object.entries(data))
      view.change(key, changeset().remove(() => true).insert(rows.map((row) => ({...row}))));
    if (state.description) element.setAttribute('aria-label', state.description);
    view.runAsync().then(placed);
  }

  function placed() {
    // A group without marks is no picture to a screen reader.
    for (const group of canvas.querySelectorAll('g[role="graphics-symbol"]')) if (!group.querySelector('path, text')) group.setAttribute('aria-hidden', 'true'); else group.removeAttribute('aria-hidden');
    const frame = element.querySelector('.role-frame.root path.background');
    if (!onFrame || !frame || signal?.aborted) return;
    const inner = frame.getBoundingClientRect(), outer = element.getBoundingClientRect();
    onFrame({left: inner.left - outer.left, top: inner.top - outer.top, width: inner.width, height: inner.height});
  }

  function build() {
    view?.finalize();
    view = new View(parse(compiled[name], config(), {ast: true}), {
      expr: expressionInterpreter, renderer: 'svg', container: canvas, hover: false, tooltip: tooltipOver(box),
      logLevel: 1,
    });
    if (width) view.width(width);
    if (onPick) view.addEventListener('click', (_, item) => { if (item?.datum?.key !== undefined) onPick(item.datum.key); });
    apply();
  }

  const watcher = new ResizeObserver(() => {
    // The axis labels take space beside the plot.
    const room = Math.floor(element.clientWidth) - 76;
    if (room < 80 || room === width) return;
    width = room;
    if (!view) build();
    else {
      view.width(width);
      apply();
    }
  });
  watcher.observe(element);
  onThemeChange(() => { if (view) build(); }, signal);
  signal?.addEventListener('abort', () => { watcher.disconnect(); view?.finalize(); }, {once: true});

  return {
    element, colour,
    update(next) {
      state = next;
      if (view) apply();
    },
  };
}
