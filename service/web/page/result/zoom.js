// Zoom and position that several pictures share.

const furthest = 32;  // picture to frame

// frames: elements whose first child holds a picture of `width` pixels. moved(state) is called for each change with what
// set() takes: [scale, x, y], the scale to the frame and the offset in frames, or null for the whole picture.
export function sharedView(frames, width, moved) {
  let scale = 1, x = 0, y = 0, shown = () => {};
  // The scale at which a pixel of the picture is one of the screen.
  const exact = () => width / devicePixelRatio / (frames[0].clientWidth || width);
  const least = () => Math.min(1, exact());
  const inside = (v) => (scale < 1 ? (1 - scale) / 2 : Math.min(0, Math.max(1 - scale, v)));
  const apply = () => {
    x = inside(x);
    y = inside(y);
    const ratio = scale / exact();
    for (const frame of frames) {
      frame.firstElementChild.style.transform = `translate(${100 * x}%, ${100 * y}%) scale(${scale})`;
      frame.classList.toggle('magnified', ratio >= 2);
    }
    shown(ratio);
  };
  const change = () => { apply(); moved(scale === 1 ? null : [scale, x, y].map((v) => Number(v.toPrecision(4)))); };
  const to = (next, px, py) => {
    next = Math.min(furthest, Math.max(least(), next));
    x = px - (px - x) * next / scale;
    y = py - (py - y) * next / scale;
    scale = next;
    change();
  };
  return {
    apply,
    // px, py: the point that stays in place, as a fraction of the frame.
    zoom: (factor, px = 0.5, py = 0.5) => to(scale * factor, px, py),
    pixels: () => to(exact(), 0.5, 0.5),
    pan(dx, dy) { x += dx; y += dy; change(); },
    whole() { scale = 1; x = y = 0; change(); },
    set(state) { [scale, x, y] = state; scale = Math.min(furthest, Math.max(0.01, scale)); apply(); },
    onShown(f) { shown = f; },
  };
}

// The wheel with Ctrl or Shift zooms, as does a double click; dragging and the arrow keys move.
export function dragAndWheel(element, view, signal) {
  const share = (event) => {
    const box = element.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
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
  }, {signal});
  addEventListener('pointerup', () => { held = null; }, {signal});
  element.addEventListener('keydown', (event) => {
    const step = 0.1;
    const moves = {ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]};
    if (event.key === '+' || event.key === '=') view.zoom(1.5);
    else if (event.key === '-') view.zoom(1 / 1.5);
    else if (event.key === '0') view.whole();
    else if (event.key === '1') view.pixels();
    else if (moves[event.key] && (event.shiftKey || element.dataset.arrows)) view.pan(...moves[event.key]);
    else return;
    event.preventDefault();
  });
}
