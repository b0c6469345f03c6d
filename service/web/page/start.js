// The head of the first page: what this is, and three things to do.
import {h} from './dom.js';

function card(title, text, ...actions) {
  return h('section', {class: 'card'}, h('h2', {}, title), h('p', {}, text), h('div', {class: 'card-actions'}, actions));
}

// compare(): shows an example. `files`: an element that takes a file. recommend(): sends what the editor holds, or the file. `error`: the
// field of the error that is allowed; `time`: that of the time it may take; `said`: why nothing was sent. Returns the element, and
// withoutExamples(), for a server that lists none.
export function startHead({compare, files, recommend, error, time, said}) {
  const show = h('button', {type: 'button', class: 'primary', onclick: compare}, 'Show the example');
  const example = card('Compare techniques on an example', 'A ball of hair, six techniques, less than a minute.', show);
  const ask = h('form', {class: 'card-actions', onsubmit: (event) => { event.preventDefault(); recommend(); }},
    h('label', {class: 'choice'}, h('span', {}, 'RMS error at most'), error), time, h('button', {type: 'submit'}, 'Recommend'));
  const element = h('div', {class: 'start'},
    h('div', {class: 'hero'},
      h('div', {}, h('h1', {tabindex: '-1'}, 'Which shadow map, and at what cost?'),
        h('p', {class: 'lead'}, 'shadowbench gives the same light rays to every shadow map technique: depth maps, deep shadow maps, adaptive nodes, moments and more. ' +
          'It measures the bytes of each map, the time of a lookup and the error of its shadows against traced rays.')),
      h('figure', {}, h('img', {src: '/assets/first.webp', width: '600', height: '400', alt: 'A ball of fine hair over a plane. Its shadow is dark and fibrous.'}),
        h('figcaption', {class: 'note'}, 'The shadow of 9,000 strands of hair in a deep shadow map.'))),
    h('div', {class: 'cards'},
      example,
      card('Bring a file', 'A mesh, hair, a volume or a deep image: light, camera and ground are placed around it.', files),
      card('Ask for a recommendation', 'The cheapest technique and settings for an error, for the scenario below, or for the file if there is none yet.', ask, said)));
  return {element, withoutExamples() { show.replaceWith(h('p', {class: 'note'}, 'This server lists no examples.')); }};
}
