// The legend of a picture: the colour ramp with its numbers, and the quantity below.
import {h} from '../dom.js';
import {significant} from '../format.js';

// The maps of errors. Each computes the value of its top colour from images.json.
export const maps = {
  heat: {
    text: '|error| of the shadow', top: (images) => images.heat_top,
    quantity: '|visibility − reference|, mean of the channels; 1 is all of the light',
  },
  difference: {
    text: 'difference of the shaded pictures', top: (images) => 1 / factorOf(images),
    quantity: '|radiance − reference| a channel; 1 is white',
  },
};

export function factorOf(images) {
  return images.difference_factor ?? 4;  // pictures of earlier versions, which do not state it, used 4
}

function ramp(kind, numbers, quantity) {
  return h('div', {class: 'legend', role: 'img', 'aria-label': `Legend: ${quantity}, from ${numbers[0]} to ${numbers.at(-1).replace('≥ ', '')}${numbers.at(-1).startsWith('≥') ? ' and above' : ''}`},
    h('div', {class: `ramp ramp-${kind}`}),
    h('div', {class: 'ramp-labels'}, numbers.map((n) => h('span', {}, n))), h('p', {class: 'quantity'}, quantity));
}

export function mapLegend(kind, images) {
  const top = maps[kind].top(images);
  return ramp(kind, ['0', significant(top / 2), `≥ ${significant(top)}`], maps[kind].quantity);
}

export function throughLegend() {
  return ramp('through', ['0', '0.5', '1'], 'share of the light that gets past all that casts shadows');
}
