// Takes a file: one of the server's data folders, around which the server makes a scenario, or a scenario from here.
import {get, post} from './api.js';
import {choice, h, setText} from './dom.js';
import {bytes, written} from './format.js';

// taken(text) is called with the text of a scenario. chosen(): whether a file of the server is. make(): as the button; whether it gave a scenario.
export function filePicker({taken, signal}) {
  const said = h('p', {class: 'note', role: 'alert'}), place = h('div', {class: 'card-actions'});
  let name = '', up = 'y';
  const failed = (error) => { if (!signal.aborted) setText(said, error.message); };
  async function make() {
    setText(said, '');
    button.disabled = true;
    try {
      taken(written(await post('/v1/new', JSON.stringify({files: [name], up}), {}, signal)));
      return true;
    } catch (error) {
      failed(error);
      return false;
    } finally {
      button.disabled = false;
    }
  }
  const button = h('button', {type: 'button', onclick: make}, 'Make a scenario');
  const own = h('input', {type: 'file', accept: '.json,application/json', 'aria-label': 'A scenario from this computer', onchange: async () => {
    const [file] = own.files;
    if (file) taken(await file.text());
  }});
  get('/v1/files', signal).then(({files, more}) => {
    if (!files.length) return setText(said, 'There are no such files in the data folders of the server (--data).');
    if (more) setText(said, 'There are more files than this list holds. The text below can name any of them.');
    name = files[0].name;
    place.replaceChildren(
      choice('File', files.map((f) => ({value: f.name, text: `${f.name}, ${bytes(f.bytes)}`})), name, (v) => { name = v; }),
      choice('Up', [{value: 'y', text: 'y'}, {value: 'z', text: 'z'}], up, (v) => { up = v; }), button);
  }).catch(failed);
  return {element: h('div', {class: 'stack'}, place, h('label', {class: 'choice'}, h('span', {}, 'or a scenario'), own), said), chosen: () => name !== '', make};
}
