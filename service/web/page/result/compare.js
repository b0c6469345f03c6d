// By eye: reference and technique under one slider, the map of their difference, and the shadows alone. All pictures share
// zoom and position. Below, the error of every technique on one scale.
import 'img-comparison-slider';
import {address} from '../address.js';
import {choice, h, setText, svg} from '../dom.js';
import {significant} from '../format.js';
import {mapLegend, maps} from './legend.js';
import {fileOf, picturesOf, titleOf, withoutMap} from './model.js';
import {dragAndWheel, sharedView} from './zoom.js';

const kinds = {shaded: 'shaded', shadow: 'shadow'};

// The error of each technique, from the least: on one scale, so that the eye can rank them.
function ranking({source, images, drawable, picked, signal}) {
  const error = (o) => picturesOf(images, o.cell).shadow?.rms;
  const sorted = [...drawable].filter((o) => fileOf(picturesOf(images, o.cell), 'heat')).sort((a, b) => (error(a) ?? Infinity) - (error(b) ?? Infinity));
  const buttons = sorted.map((o) => {
    const image = h('img', {alt: ''});
    image.style.aspectRatio = images.resolution.join(' / ');
    source.picture(fileOf(picturesOf(images, o.cell), 'heat'), signal).then((url) => { image.src = url; }, () => {});
    return h('button', {type: 'button', class: 'ranked', 'data-index': o.value, onclick: () => picked(o.value)}, image,
      h('span', {}, titleOf(o.cell)), h('small', {}, `RMS ${significant(error(o), 2)}`));
  });
  return {
    element: h('div', {}, h('h3', {id: 'ranking-title'}, '|error| of every shadow, on one scale'), h('div', {class: 'ranking', role: 'group', 'aria-labelledby': 'ranking-title'}, buttons), mapLegend('heat', images)),
    update(index) { for (const b of buttons) b.setAttribute('aria-pressed', String(Number(b.dataset.index) === index)); },
  };
}

// picked(index): a technique is chosen here. update(index of the cell).
export function compareView({source, images, cells, picked, signal}) {
  const [width, height] = images.resolution;
  const content = () => h('div', {class: 'frame-content'}, h('img', {alt: '', draggable: 'false'}));
  const frame = (more) => {
    const made = h('div', {class: 'frame', ...more}, content());
    made.style.aspectRatio = `${width} / ${height}`;
    return made;
  };
  const pane = () => frame({tabindex: '0', 'data-arrows': 'true', role: 'img'});
  const left = frame({slot: 'first'}), right = frame({slot: 'second'}), mapFrame = pane(), trueShadow = pane(), shadow = pane();
  const slider = h('img-comparison-slider', {handle: true, keyboard: 'enabled', role: 'slider', tabindex: '0', 'aria-valuemin': '0', 'aria-valuemax': '100', 'aria-valuenow': '50'},
    left, right, h('div', {slot: 'handle', class: 'knob'}, svg('svg', {viewBox: '-10 -10 20 20', 'aria-hidden': 'true'},
      svg('path', {d: 'M-3,-4L-7,0L-3,4M3,-4L7,0L3,4'}))));
  const split = address.numbers('split', 1);
  if (split) {
    slider.value = Math.max(0, Math.min(100, split[0]));
    slider.setAttribute('aria-valuenow', String(Math.round(slider.value)));
  }
  const stage = h('div', {class: 'stage'}, slider);
  const view = sharedView([left, right, mapFrame, trueShadow, shadow], width, (state) => address.keep({zoom: state && state.join(',')}));
  for (const element of [stage, mapFrame, trueShadow, shadow]) dragAndWheel(element, view, signal);
  slider.addEventListener('slide', () => {
    const at = Math.round(slider.value);
    slider.setAttribute('aria-valuenow', String(at));
    address.keep({split: at === 50 ? null : at});
  });

  const zoomText = h('output', {'aria-label': 'Pixels of the screen for one of the picture'}, '');
  view.onShown((ratio) => setText(zoomText, `${significant(ratio, 2)} : 1`));
  const rightName = h('span', {}), shadowName = h('span', {}), mapName = h('span', {}), legendPlace = h('div');
  let kind = address.word('picture', Object.keys(kinds)), map = address.word('map', Object.keys(maps)), index = null;

  async function show(element, file, text) {
    const image = element.querySelector('img');
    if (element.getAttribute('role') === 'img') element.setAttribute('aria-label', `${text}; plus and minus zoom, arrows move`);
    else image.alt = text;
    if (file) image.src = await source.picture(file, signal).catch(() => '');
    else image.removeAttribute('src');
  }
  function draw() {
    const cell = cells[index], pictures = picturesOf(images, cell), title = titleOf(cell);
    const reference = (name) => images.reference.files.find((file) => file.endsWith(`${name}.png`));
    setText(rightName, title);
    setText(shadowName, title);
    slider.setAttribute('aria-label', `Share of the reference shown, against ${title}`);
    setText(mapName, maps[map].text);
    legendPlace.replaceChildren(mapLegend(map, images));
    show(left, reference(kind), `reference, ${kind}`);
    show(right, fileOf(pictures, kind), `${title}, ${kind}`);
    show(mapFrame, fileOf(pictures, map), `${maps[map].text}, ${title}`);
    show(trueShadow, reference('shadow'), 'Shadow alone, reference');
    show(shadow, fileOf(pictures, 'shadow'), `Shadow alone, ${title}`);
    ranks.update(index);
    view.apply();
  }
  const drawable = cells.map((cell, i) => ({value: i, text: `${i + 1}  ${titleOf(cell)}`, cell})).filter((o) => picturesOf(images, o.cell));
  const ranks = ranking({source, images, drawable, picked, signal});
  const technique = choice('Technique', drawable, 0, (value) => picked(Number(value)));
  const button = (text, label, act) => h('button', {type: 'button', class: 'quiet', 'aria-label': label, onclick: act}, text);
  const element = h('section', {class: 'panel', id: 'compare', 'aria-labelledby': 'compare-title'},
    h('div', {class: 'panel-head'}, h('h2', {id: 'compare-title'}, 'By eye'),
      h('div', {class: 'choices'}, technique,
        choice('Picture', [{value: 'shaded', text: 'shaded'}, {value: 'shadow', text: 'shadow alone'}], kind, (v) => { kind = v; address.go({picture: v}); draw(); }),
        choice('Map', Object.entries(maps).map(([value, m]) => ({value, text: m.text})), map, (v) => { map = v; address.go({map: v}); draw(); }),
        h('div', {class: 'zoom', role: 'group', 'aria-label': 'Zoom'},
          button('−', 'Zoom out', () => view.zoom(1 / 1.5)), zoomText, button('+', 'Zoom in', () => view.zoom(1.5)),
          button('1 : 1', 'One pixel of the picture is one of the screen', view.pixels), button('Whole', 'Whole picture', view.whole)))),
    h('div', {class: 'pair'},
      h('figure', {}, stage, h('figcaption', {class: 'sides'}, h('span', {}, 'reference'), rightName)),
      h('figure', {}, mapFrame, h('figcaption', {}, mapName), legendPlace),
      h('figure', {}, trueShadow, h('figcaption', {}, 'the shadow alone: reference')),
      h('figure', {}, shadow, h('figcaption', {}, 'the shadow alone: ', shadowName))),
    h('p', {class: 'note'}, 'Drag the handle, or use the arrow keys on it. Double-click or Ctrl + wheel to zoom, and drag to move, all pictures.'),
    ranks.element);
  const state = address.numbers('zoom', 3);
  if (state) view.set(state);
  new ResizeObserver((_, self) => { if (signal.aborted) self.disconnect(); else view.apply(); }).observe(mapFrame);
  return {
    element,
    update(next) {
      // What has no pictures leaves those that are shown. At first these are of a map, not of the reference.
      const known = drawable.some((o) => o.value === next);
      if (!known && index !== null) return;
      index = known ? next : (drawable.find((o) => !withoutMap(o.cell)) ?? drawable[0]).value;
      technique.querySelector('select').value = String(index);
      draw();
    },
  };
}
