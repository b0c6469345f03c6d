// Shows the page that the address names: #/ to submit, #/jobs, #/jobs/<id>, #/compare/<id>/<id>, #/explore.
import {changed, pathOf} from './address.js';
import {onTokenNeeded} from './api.js';
import {comparisonView} from './comparison.js';
import {h} from './dom.js';
import {exploreView} from './explore.js';
import {written} from './format.js';
import {jobView} from './job.js';
import {jobsView} from './jobs.js';
import {submitView} from './submit.js';

const main = document.getElementById('main');
let shown = null, draft = null;

function go(address) {
  if (location.hash === address) show();
  else location.hash = address;
}

// asked: {error, within}, what a recommendation of it is asked for; what is null is as usual.
function edit(scenario, asked) {
  draft = written(scenario);
  go(changed('#/', asked));
}

// A typed address may contain a % that begins no escape.
function decoded(part) {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}

// A page follows changes of its own state itself.
function route(event) {
  if (pathOf(location.hash) !== pathOf(new URL(event.oldURL).hash)) show(event);
}

function show(event) {
  const path = pathOf(location.hash);
  shown?.abort();
  shown = new AbortController();
  const {signal} = shown;
  const [, page = '', ...ids] = path.split('/').map(decoded);
  document.title = 'shadowbench';
  const view = page === 'jobs' && ids[0] ? jobView({id: ids[0], signal, edit})
    : page === 'jobs' ? jobsView({signal}) : page === 'compare' ? comparisonView({ids, signal}) : page === 'explore' ? exploreView({signal}) : submitView({draft, signal, go});
  draft = null;
  main.replaceChildren(view);
  const here = ['jobs', 'compare', 'explore'].includes(page) ? `#/${page}` : '#/';
  for (const link of document.querySelectorAll('nav a'))
    link.getAttribute('href') === here ? link.setAttribute('aria-current', 'page') : link.removeAttribute('aria-current');
  if (event) {  // not for the first page
    scrollTo(0, 0);
    view.querySelector('h1')?.focus();
  }
}

// A form for the token of the server. `refused`: the server refused an earlier token.
onTokenNeeded((refused) => new Promise((resolve) => {
  const field = h('input', {type: 'password', autocomplete: 'off', required: true, id: 'token'});
  const dialog = h('dialog', {'aria-labelledby': 'token-title'}, h('form', {method: 'dialog', onsubmit: (event) => {
    event.preventDefault();
    dialog.remove();
    resolve(field.value.trim());
  }}, h('h2', {id: 'token-title'}, 'This server requires a token'),
  refused && h('p', {class: 'problem', role: 'alert'}, 'The server refused that token.'),
  h('p', {class: 'note'}, 'The token is kept only in this tab.'), h('label', {for: 'token'}, 'Token'), field,
  h('button', {type: 'submit', class: 'primary'}, 'Use it')));
  dialog.addEventListener('cancel', (event) => event.preventDefault());
  document.body.append(dialog);
  dialog.showModal();
}));

document.getElementById('skip').addEventListener('click', (event) => {
  event.preventDefault();  // the address names a page
  main.focus();
});
addEventListener('hashchange', route);
show();
