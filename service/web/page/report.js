// A result as one file. The page contains all its data and has no server.
import {h} from './dom.js';
import {recommendationParts, shownFirst} from './result/recommendation.js';
import {resultView, summaryOf} from './result/view.js';

const {result, images, pictures} = JSON.parse(document.getElementById('data').textContent);
const source = {
  picture: async (file) => {
    if (!(file in pictures)) throw new Error('not in this report');
    return pictures[file];
  },
};
const {signal} = new AbortController();
document.getElementById('main').append(h('div', {class: 'stack'},
  h('div', {class: 'page-head'}, h('h1', {}, result.name ?? 'unnamed')),
  h('p', {class: 'purpose'}, result.purpose ?? ''),
  ...recommendationParts({result, name: result.name, signal}),
  resultView({source, result, images, ...shownFirst(result), signal}),
  h('section', {class: 'panel quiet-panel', 'aria-label': 'Summary'}, summaryOf(result))));
