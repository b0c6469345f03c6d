// The part of the depth axis that is shown: buttons, or the wheel and dragging on the plots.
import {h, setText} from '../dom.js';
import {significant} from '../format.js';

const closest = 1e-4;  // of the whole range

// places: the elements of the plots. start: [low, high] or nothing. moved([low, high]) is called for each change, with null for
// the whole range.
export function depthRange({places, nearest, furthest, start, moved}) {
  const whole = furthest - nearest;
  let low = nearest, high = furthest;
  const take = (from, to) => {
    const size = Math.min(whole, Math.max(closest * whole, to - from));
    low = Math.max(nearest, Math.min(furthest - size, from));
    high = low + size;
  };
  if (start && start[1] > start[0]) take(...start);
  const said = h('output', {'aria-label': 'Depths that are shown'});
  const say = () => setText(said, `${significant(low, 4)} to ${significant(high, 4)}`);
  const set = (from, to) => {
    take(from, to);
    say();
    moved(high - low < whole * (1 - 1e-9) ? [low, high] : null);
  };
  const zoom = (factor, part = 0.5) => {
    const middle = low + part * (high - low);
    set(middle - (middle - low) / factor, middle + (high - middle) / factor);
  };
  const pan = (part) => { const by = part * (high - low); set(low + by, high + by); };
  for (const place of places) {
    const frame = () => (place.querySelector('.role-frame.root path.background') ?? place).getBoundingClientRect();
    place.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && !event.shiftKey) return;
      event.preventDefault();
      const box = frame();
      zoom(Math.exp(-(event.deltaY || event.deltaX) / 300), Math.max(0, Math.min(1, (event.clientX - box.left) / box.width)));
    }, {passive: false});
    let held = null;
    place.addEventListener('pointerdown', (event) => { held = event.clientX; place.setPointerCapture(event.pointerId); });
    place.addEventListener('pointermove', (event) => {
      if (held === null || !(event.buttons & 1)) return;
      pan((held - event.clientX) / frame().width);
      held = event.clientX;
    });
    place.addEventListener('pointerup', () => { held = null; });
  }
  say();
  const button = (text, label, act) => h('button', {type: 'button', class: 'quiet', 'aria-label': label, onclick: act}, text);
  return {
    range: () => [low, high],
    element: h('div', {class: 'zoom depth', role: 'group', 'aria-label': 'Depth axis'}, h('span', {}, 'depth'),
      button('‹', 'Nearer depths', () => pan(-0.25)), button('−', 'Show more depths', () => zoom(0.5)), said,
      button('+', 'Show fewer depths', () => zoom(2)), button('›', 'Further depths', () => pan(0.25)), button('Whole', 'Show all depths', () => set(nearest, furthest))),
  };
}
