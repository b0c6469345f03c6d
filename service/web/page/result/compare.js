// Shows the reference and a technique under one slider, beside a map of their difference. All pictures share zoom and pan.
import 'img-comparison-slider';
import {choice, h, setText, svg} from '../dom.js';
import {significant} from '../format.js';
import {mapLegend, maps} from './legend.js';
import {fileOf, picturesOf, titleOf} from './model.js';

const furthest = 32;

// One transform for every image in `frames`.
function sharedView(frames) {
  let scale = 1, x = 0, y = 0, changed = () => {};
  const clampAll = () => {
    const low = 1 - scale;
    x = Math.min(0, Math.max(low, x));
    y = Math.min(0, Math.max(low, y));
  };
  const apply = () => {
    clampAll();
    for (const frame of frames) {
      const content = frame.firstElementChild;
      content.style.transform = `translate(${100 * x}%, ${100 * y}%) scale(${scale})`;
      frame.classList.toggle('magnified', scale > 2);
    }
    changed(scale);
  };
  // px, py: the point that stays in place, as a fraction of the frame.
  const zoom = (factor, px = 0.5, py = 0.5) => {
    const next = Math.min(furthest, Math.max(1, scale * factor));
    x = px - (px - x) * next / scale;
    y = py - (py - y) * next / scale;
    scale = next;
    apply();
  };
  const pan = (dx, dy) => { x += dx; y += dy; apply(); };
  const reset = () => { scale = 1; x = y = 0; apply(); };
  return {zoom, pan, reset, apply, onChange: (f) => { changed = f; }};
}

function dragAndWheel(element, view) {
  const share = (event) => {
    const box = element.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height, box];
  };
  element.addEventListener('wheel', (event) => {
    if (!event.ctrlKey && !event.shiftKey && !element.contains(document.activeElement)) return;
    event.preventDefault();
    const [x, y] = share(event);
    view.zoom(Math.exp(-(event.deltaY || event.deltaX) / 300), x, y);
  }, {passive: false});
  element.addEventListener('dblclick', (event) => { const [x, y] = share(event); view.zoom(2, x, y); });
  let held = null;
  element.addEventListener('pointerdown', (event) => {
    held = event.target.closest('.knob') ? null : [event.clientX, event.clientY];  // the handle moves only the divider
  });
  addEventListener('pointermove', (event) => {
    if (!held || !(event.buttons & 1)) return;
    const box = element.getBoundingClientRect();
    view.pan((event.clientX - held[0]) / box.width, (event.clientY - held[1]) / box.height);
    held = [event.clientX, event.clientY];
  });
  addEventListener('pointerup', () => { held = null; });
  element.addEventListener('keydown', (event) => {
    const step = 0.1;
    const moves = {ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]};
    if (event.key === '+' || event.key === '=') view.zoom(1.5);
    else if (event.key === '-') view.zoom(1 / 1.5);
    else if (event.key === '0') view.reset();
    else if (moves[event.key] && (event.shiftKey || element.dataset.arrows)) view.pan(...moves[event.key]);
    else return;
    event.preventDefault();
  });
}

// update(index of the cell).
export function compareView({source, images, cells, signal}) {
  const [width, height] = images.resolution;
  const picture = () => h('div', {class: 'frame-content'}, h('img', {alt: '', draggable: 'false'}));
  const frame = (slot) => h('div', {class: 'frame', slot}, picture());
  const left = frame('first'), right = frame('second'), mapFrame = h('div', {class: 'frame', tabindex: '0', 'data-arrows': 'true', role: 'img'}, picture());
  const slider = h('img-comparison-slider', {handle: true, keyboard: 'enabled', role: 'slider', tabindex: '0', 'aria-valuemin': '0', 'aria-valuemax': '100', 'aria-valuenow': '50'},
    left, right, h('div', {slot: 'handle', class: 'knob'}, svg('svg', {viewBox: '-10 -10 20 20', 'aria-hidden': 'true'},
      svg('path', {d: 'M-3,-4L-7,0L-3,4M3,-4L7,0L3,4'}))));
  const stage = h('div', {class: 'stage'}, slider);
  for (const f of [left, right, mapFrame]) f.style.aspectRatio = `${width} / ${height}`;
  const view = sharedView([left, right, mapFrame]);
  dragAndWheel(stage, view);
  dragAndWheel(mapFrame, view);
  slider.addEventListener('slide', () => slider.setAttribute('aria-valuenow', String(Math.round(slider.value))));

  const zoomText = h('output', {}, '1 ×');
  view.onChange((scale) => setText(zoomText, `${significant(scale, 2)} ×`));
  const leftName = h('span', {}, 'reference'), rightName = h('span', {});
  const mapName = h('span', {}), legendPlace = h('div');
  let kind = 'shaded', map = 'heat', index = 0;

  async function show(element, file, text) {
    const image = element.querySelector('img');
    image.alt = text;
    if (file) image.src = await source.picture(file, signal).catch(() => '');
    else image.removeAttribute('src');
  }
  function draw() {
    const cell = cells[index], pictures = picturesOf(images, cell);
    setText(rightName, titleOf(cell));
    slider.setAttribute('aria-label', `Share of the reference shown, against ${titleOf(cell)}`);
    setText(mapName, maps[map].text);
    mapFrame.setAttribute('aria-label', `${maps[map].text}, ${titleOf(cell)}; plus and minus zoom, arrows move`);
    legendPlace.replaceChildren(mapLegend(map, images));
    show(left, images.reference.files.find((name) => name.endsWith(`${kind}.png`)), `reference, ${kind}`);
    show(right, fileOf(pictures, kind), `${titleOf(cell)}, ${kind}`);
    show(mapFrame, fileOf(pictures, map), '');
    view.apply();
  }
  const drawable = cells.map((cell, i) => ({value: i, text: `${i + 1}  ${titleOf(cell)}`, cell})).filter((o) => picturesOf(images, o.cell));
  const technique = choice('Technique', drawable, 0, (value) => { index = Number(value); draw(); });
  const button = (text, label, act) => h('button', {type: 'button', class: 'quiet', 'aria-label': label, onclick: act}, text);
  const element = h('section', {class: 'panel', id: 'compare', 'aria-labelledby': 'compare-title'},
    h('div', {class: 'panel-head'}, h('h2', {id: 'compare-title'}, 'By eye'),
      h('div', {class: 'choices'}, technique,
        choice('Picture', [{value: 'shaded', text: 'shaded'}, {value: 'shadow', text: 'shadow alone'}], kind, (v) => { kind = v; draw(); }),
        choice('Map', Object.entries(maps).map(([value, m]) => ({value, text: m.text})), map, (v) => { map = v; draw(); }),
        h('div', {class: 'zoom', role: 'group', 'aria-label': 'Zoom'},
          button('−', 'Zoom out', () => view.zoom(1 / 1.5)), zoomText, button('+', 'Zoom in', () => view.zoom(1.5)), button('1 : 1', 'Whole picture', view.reset)))),
    h('div', {class: 'pair'},
      h('figure', {}, stage, h('figcaption', {class: 'sides'}, leftName, rightName)),
      h('figure', {}, mapFrame, h('figcaption', {}, mapName), legendPlace)),
    h('p', {class: 'note'}, 'Drag the handle, or use the arrow keys on it. Double-click or Ctrl + wheel to zoom, and drag to move, all pictures.'));
  return {
    element,
    update(next) {
      if (!drawable.some((o) => o.value === next)) return;
      index = next;
      technique.querySelector('select').value = String(next);
      draw();
    },
  };
}
