// Saves a plot that is shown as SVG or PNG, with its title and the names of its axes.
import {download, h, svg} from '../dom.js';

const margin = 16, line = 18, scale = 2;  // pixels; picture pixels for one of the plot

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

// texts: {title, up, across}. Nothing if the plot is not drawn yet.
function drawing(element, {title, up, across}, level) {
  const shown = element.querySelector('.plot svg');
  if (!shown) return null;
  const {width, height} = shown.getBoundingClientRect(), head = margin + 2 * line;
  const whole = [Math.ceil(width + 2 * margin), Math.ceil(height + head + line + margin)];
  const inner = shown.cloneNode(true);
  for (const [name, value] of [['x', margin], ['y', head], ['width', width], ['height', height]]) inner.setAttribute(name, String(value));
  const text = (words, x, y, more) => svg('text', {x, y, fill: colour('ink'), 'font-family': 'sans-serif', 'font-size': 12, ...more}, words);
  const out = svg('svg', {xmlns: 'http://www.w3.org/2000/svg', width: whole[0], height: whole[1], viewBox: `0 0 ${whole.join(' ')}`},
    svg('rect', {width: whole[0], height: whole[1], fill: colour('panel')}),
    text(title, margin, margin + 8, {'font-weight': 600, 'font-size': 13}), text(up, margin, margin + 8 + line), inner,
    text(across, whole[0] - margin, whole[1] - margin / 2, {'text-anchor': 'end'}));
  if (level) {
    const frame = element.querySelector('.budget')?.getBoundingClientRect(), place = shown.getBoundingClientRect();
    const y = head + frame.top - place.top + frame.height * parseFloat(element.querySelector('.budget').style.getPropertyValue('--share')) / 100;
    const x = margin + frame.left - place.left;
    out.append(svg('path', {d: `M${x},${y}H${x + frame.width}`, stroke: colour('accent'), 'stroke-width': 1.5, 'stroke-dasharray': '6 3'}),
      text(level, x + 4, y - 4, {fill: colour('accent'), 'font-size': 11}));
  }
  return {text: new XMLSerializer().serializeToString(out), whole};
}

async function pngOf({text, whole}) {
  const url = URL.createObjectURL(new Blob([text], {type: 'image/svg+xml'}));
  const image = new Image();
  image.src = url;
  await image.decode();
  const canvas = h('canvas', {width: scale * whole[0], height: scale * whole[1]});
  canvas.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(url);
  return new Promise((resolve) => { canvas.toBlob(resolve, 'image/png'); });
}

// name(): of the file, without its ending. texts(): as above; `level`: the words at the line of plots that have one.
export function saveButtons(element, name, texts) {
  const save = async (kind) => {
    const {level, ...words} = texts(), made = drawing(element, words, level);
    if (!made) return;
    if (kind === 'svg') download(`${name()}.svg`, 'image/svg+xml', made.text);
    else download(`${name()}.png`, 'image/png', await pngOf(made));
  };
  return h('span', {class: 'save', role: 'group', 'aria-label': 'Save the plot'},
    ['svg', 'png'].map((kind) => h('button', {type: 'button', class: 'quiet small', onclick: () => save(kind), 'aria-label': `Save the plot as ${kind.toUpperCase()}`}, kind.toUpperCase())));
}
