// A line across plots with a logarithmic vertical axis: the error that is allowed. It is dragged, or moved with the keys.
import {h} from '../dom.js';
import {significant} from '../format.js';

const step = 0.01;  // of the axis, for an arrow key

// label: of the line, for screen readers. moved(value, last) is called for each new value; `last` when a drag ends.
export function budgetLine({label, moved, signal}) {
  const line = h('div', {class: 'budget-line', role: 'slider', tabindex: '0', 'aria-orientation': 'vertical', 'aria-label': label}, h('span', {class: 'budget-grip', 'aria-hidden': 'true'}));
  const element = h('div', {class: 'budget', hidden: true}, h('div', {class: 'budget-above'}), line);
  let low = 0.1, high = 1, value = 0.1, held = false;
  const share = () => Math.max(0, Math.min(1, Math.log(value / low) / Math.log(high / low)));
  const at = (part) => Number((low * (high / low) ** Math.max(0, Math.min(1, part))).toPrecision(2));

  function draw() {
    element.style.setProperty('--share', `${100 * (1 - share())}%`);
    for (const [name, v] of [['min', low], ['max', high], ['now', value]]) line.setAttribute(`aria-value${name}`, String(Number(v.toPrecision(4))));
    line.setAttribute('aria-valuetext', significant(value));
  }
  const set = (next, last) => { if (next !== value || last) { value = next; draw(); moved(value, last); } };
  line.addEventListener('pointerdown', (event) => { held = true; line.setPointerCapture(event.pointerId); });
  line.addEventListener('pointermove', (event) => {
    if (!held) return;
    const box = element.getBoundingClientRect();
    set(at(1 - (event.clientY - box.top) / box.height), false);
  });
  for (const end of ['pointerup', 'pointercancel']) line.addEventListener(end, () => { if (held) { held = false; set(value, true); } });
  line.addEventListener('keydown', (event) => {
    const moves = {ArrowUp: step, ArrowRight: step, ArrowDown: -step, ArrowLeft: -step, PageUp: 10 * step, PageDown: -10 * step};
    const target = event.key === 'Home' ? 0 : event.key === 'End' ? 1 : moves[event.key] && share() + moves[event.key];
    if (target === undefined) return;
    event.preventDefault();
    // Two digits may round a small step away.
    for (let n = 1, next; n < 20; ++n) {
      next = at(event.key in moves ? share() + n * moves[event.key] : target);
      if (next !== value) { set(next, true); return; }
    }
  });
  signal?.addEventListener('abort', () => { held = false; }, {once: true});
  return {
    element,
    // Where the plot's data stands in its element.
    frame({left, top, width, height}) {
      Object.assign(element.style, {left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px`});
      element.hidden = false;
    },
    update(next, axis) { value = next; low = axis.y_low; high = axis.y_high; draw(); },
  };
}
