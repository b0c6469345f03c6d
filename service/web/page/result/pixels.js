// The map of a light, in which a pixel can be chosen. It shows a picture of the transmittance or, without one, the pixels that
// have been read.
import {h} from '../dom.js';

const stride = 8;  // pixels that Shift + arrow key moves
const largestCanvas = 1024;  // pixels per side

// The transfer function of sRGB, which the pictures use.
function toDisplay(linear) {
  const v = Math.max(0, Math.min(1, linear));
  return v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
}

function moveOf(event, up) {
  const step = event.shiftKey ? stride : 1, down = up ? -step : step;
  return {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -down], ArrowDown: [0, down]}[event.key];
}

// up: y grows upwards, as the light sees it. ask(x, y) is called for the pixel under the pointer, leave() when it leaves, choose(x, y, moves) for the
// chosen pixel; `moves`: by a key, of which many may follow.
export function pixelGrid({name, width, height, up, ask, leave, choose}) {
  const scale = Math.min(1, largestCanvas / Math.max(width, height));
  const canvas = h('canvas', {width: Math.ceil(scale * width), height: Math.ceil(scale * height), 'aria-hidden': 'true'});
  const picture = h('img', {alt: '', draggable: 'false', hidden: true});
  const marker = h('div', {class: 'marker', hidden: true});
  const element = h('div', {class: 'grid', tabindex: '0', role: 'application', 'aria-roledescription': 'pixel chooser'},
    canvas, picture, marker);
  element.style.aspectRatio = `${width} / ${height}`;
  const paint = canvas.getContext('2d');
  paint.scale(canvas.width / width, canvas.height / height);
  const rowOf = (y) => (up ? height - 1 - y : y);
  let at;
  const pixel = (event) => {
    const box = canvas.getBoundingClientRect();  // within the border
    const clamp = (v, n) => Math.max(0, Math.min(n - 1, Math.floor(v * n)));
    return [clamp((event.clientX - box.left) / box.width, width), rowOf(clamp((event.clientY - box.top) / box.height, height))];
  };
  element.addEventListener('pointermove', (event) => ask(...pixel(event)));
  element.addEventListener('pointerleave', leave);
  element.addEventListener('click', (event) => choose(...pixel(event)));
  element.addEventListener('keydown', (event) => {
    const move = moveOf(event, up);
    if (!move) return;
    event.preventDefault();
    choose(Math.max(0, Math.min(width - 1, at[0] + move[0])), Math.max(0, Math.min(height - 1, at[1] + move[1])), true);
  });
  const stand = (x, y) => {
    at = [x, y];
    element.setAttribute('aria-label', `${name}, ${width} by ${height} pixels, at ${x}, ${y}. Arrow keys choose a pixel, with Shift ${stride} further`);
  };
  stand(Math.floor(width / 2), Math.floor(height / 2));
  const mark = (x, y) => {
    stand(x, y);
    marker.hidden = false;
    marker.style.left = `${100 * x / width}%`;
    marker.style.top = `${100 * rowOf(y) / height}%`;
    marker.style.width = `${100 / width}%`;
    marker.style.height = `${100 / height}%`;
  };
  return {
    element, mark,
    // Shows a picture of the whole map in place of the painted pixels.
    show(url) {
      picture.src = url;
      picture.hidden = false;
    },
    // Paints a block of pixels with its lowest coordinates x and y; colour: linear, one value per channel.
    fill(x, y, w, h_, colour) {
      const [r, g, b] = [0, 1, 2].map((c) => Math.round(255 * toDisplay(colour[colour.length === 1 ? 0 : c])));
      paint.fillStyle = `rgb(${r} ${g} ${b})`;
      paint.fillRect(x, up ? height - y - h_ : y, w, h_);
    },
  };
}
