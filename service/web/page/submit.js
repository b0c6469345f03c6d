// The page on which the user edits and submits a scenario.
import {get, post} from './api.js';
import {typesOf} from './choices.js';
import {choice, h, setText} from './dom.js';
import {filePicker} from './files.js';
import {choicesForm} from './form.js';
import {bytes, newKey, plural, seconds, written} from './format.js';
import {JsonFault, lineOf, offsetOf, places} from './pointer.js';
import {question} from './question.js';
import {startHead} from './start.js';

const checkPause = 400;  // milliseconds after the last key
const draftKey = 'shadowbench-draft';
const nothingYet = 'There is no scenario yet: make one of a file, open one from this computer, or write it here.';

// A text area whose lines have numbers and can be marked. changed() is called for every change; for input by the user typed() is called before it.
function editor(changed, typed) {
  const area = h('textarea', {id: 'scenario', spellcheck: 'false', autocomplete: 'off', autocapitalize: 'off', wrap: 'off', 'aria-describedby': 'verdict'});
  const numbers = h('div', {class: 'numbers', 'aria-hidden': 'true'});
  const marks = h('div', {class: 'line-marks', 'aria-hidden': 'true'});
  let marked = new Set();
  function draw() {
    const lines = area.value.split('\n').length;
    const rows = Array.from({length: lines}, (_, i) => [i, marked.has(i)]);
    numbers.replaceChildren(...rows.map(([i, bad]) => h('div', {class: bad ? 'bad' : null}, String(i + 1))));
    marks.replaceChildren(...rows.map(([, bad]) => h('div', {class: bad ? 'bad' : null}, '\u200b')));
    scrolled();
  }
  function scrolled() {
    numbers.style.transform = marks.style.transform = `translateY(${-area.scrollTop}px)`;
  }
  area.addEventListener('input', () => { marked = new Set(); draw(); typed(); changed(); });
  area.addEventListener('scroll', scrolled);
  return {
    element: h('div', {class: 'editor'}, h('div', {class: 'numbers-box'}, numbers), h('div', {class: 'area-box'}, marks, area)),
    text: () => area.value,
    set(text) { area.value = text; marked = new Set(); area.scrollTop = 0; draw(); changed(); },
    mark(lines) { marked = new Set(lines); area.setAttribute('aria-invalid', String(marked.size > 0)); draw(); },
    go(offset) {
      const line = lineOf(area.value, offset);
      area.focus();
      area.setSelectionRange(offset, offset);
      area.scrollTop = Math.max(0, (line - 5) * parseFloat(getComputedStyle(area).lineHeight));
    },
  };
}

// The faults of a problem as {offset, line, pointer, detail}.
function faultsOf(problem, text) {
  let map = new Map();
  try { map = places(text); } catch { /* the server accepts what the scanner does not */ }
  const errors = problem.errors.length ? problem.errors : [{pointer: '', detail: problem.message}];
  return errors.map(({pointer = '', detail}) => {
    const offset = offsetOf(map, pointer);
    return {offset, line: lineOf(text, offset), pointer, detail};
  });
}

// A technique may stand in a scenario with several settings; "*" stands for all.
function techniquesOf(answer, text) {
  const types = typesOf(JSON.parse(text), []).size;
  return types > 1 && types < answer.techniques && !text.includes('"*"') ? `${answer.techniques} settings of ${types} techniques` : plural(answer.techniques, 'technique');
}

function summaryOf(answer, text) {
  const parts = [plural(answer.variants, 'variant'), plural(answer.lights, 'light'), techniquesOf(answer, text)];
  const {seconds: time, bytes: memory} = answer.estimate ?? {};
  if (Number.isFinite(time)) parts.push(`about ${seconds(time)}`);
  if (Number.isFinite(memory)) parts.push(`at least ${bytes(memory)}`);
  return `Valid: ${parts.join(', ')}.`.replace(/(\d) (?=(?:ms|s|min|h|B|[KMGT]iB)\b)/g, '$1\u00a0');  // units stay with their numbers
}

export function submitView({draft, signal, go}) {
  const verdict = h('div', {id: 'verdict', class: 'verdict-box', role: 'status'});
  const problem = h('p', {class: 'problem', role: 'alert'}), asked = h('p', {class: 'problem', role: 'alert'});
  let timer = 0, checks = 0, cache = 'reuse', key = newKey();

  function showFaults(faults) {
    edit.mark(faults.map((f) => f.line));
    verdict.replaceChildren(h('p', {class: 'bad-title'}, `${plural(faults.length, 'fault')}:`), h('ul', {class: 'faults'}, faults.map((f) =>
      h('li', {}, h('button', {type: 'button', class: 'link', onclick: () => edit.go(f.offset)}, `line ${f.line + 1}`),
        f.pointer && h('code', {}, f.pointer), h('span', {}, ` ${f.detail}`)))));
  }
  function syntaxFault(text) {
    try {
      places(text);
      return null;
    } catch (error) {
      if (!(error instanceof JsonFault)) throw error;
      return {offset: error.offset, line: lineOf(text, error.offset), pointer: '', detail: `${error.message}.`};
    }
  }
  async function check() {
    const text = edit.text(), turn = ++checks;
    if (!text.trim()) { edit.mark([]); return verdict.replaceChildren(h('p', {class: 'note'}, nothingYet)); }
    sessionStorage.setItem(draftKey, text);
    const fault = syntaxFault(text);
    if (fault) return showFaults([fault]);
    try {
      const answer = await post('/v1/validate', text, {}, signal);
      if (turn !== checks) return;
      edit.mark([]);
      verdict.replaceChildren(h('p', {class: 'good'}, h('span', {'aria-hidden': 'true'}, '✓ '), summaryOf(answer, text)),
        ...(answer.notes ?? []).map((note) => h('p', {class: 'note'}, note)));
    } catch (error) {
      if (signal.aborted || turn !== checks) return;
      if (error.status === 422 || error.status === 400) showFaults(faultsOf(error, text));
      else verdict.replaceChildren(h('p', {class: 'problem'}, error.message));
    }
  }
  const edit = editor(() => {
    setText(problem, '');
    setText(asked, '');
    key = newKey();  // a new text is a new request
    form.show();
    clearTimeout(timer);
    timer = setTimeout(check, checkPause);
  }, own);
  // The text is no longer an example.
  function own() {
    setText(purpose, '');
    const select = examples.querySelector('select');
    if (select) select.value = '';
  }
  const asks = question({signal});
  const form = choicesForm({text: edit.text, write(text) { own(); edit.set(text); }, error: asks.errors[1], signal});
  signal.addEventListener('abort', () => clearTimeout(timer), {once: true});

  // Without a scenario, makes one of the file that is chosen. `said`: the element beside the button that was used.
  async function filled(said) {
    if (edit.text().trim()) return true;
    if (picker?.chosen()) return picker.make();
    setText(said, nothingYet);
    return false;
  }
  // Sends the scenario, with `more` members of the request, to the path. Goes to its job. `said` gets why nothing was sent.
  async function send(path, more, said) {
    if (!await filled(said)) return;
    const text = edit.text(), fault = syntaxFault(text);
    if (fault) {
      showFaults([fault]);
      setText(said, `Nothing was sent. Line ${fault.line + 1} of the scenario: ${fault.detail}`);
      return edit.go(fault.offset);
    }
    for (const b of buttons()) b.disabled = true;
    try {
      const job = await post(path, `{"scenario": ${text}, ${more}}`, {'Idempotency-Key': key}, signal);
      sessionStorage.removeItem(draftKey);
      go(`#/jobs/${job.id}${path === '/v1/jobs' && asks.asked() ? `?budget=${asks.error()}` : ''}`);
    } catch (error) {
      if (signal.aborted) return;
      if (error.status === 422 || error.status === 400) showFaults(faultsOf(error, text));
      const wait = error.retryAfter ? ` Try again in ${seconds(error.retryAfter)}.` : '';
      setText(said, `Not accepted: ${error.message}${wait}`);
      said.scrollIntoView({block: 'nearest'});
    } finally {
      for (const b of buttons()) b.disabled = false;
    }
  }
  const buttons = () => element.querySelectorAll('button[type="submit"], button.send');
  const run = () => send('/v1/jobs', `"options": ${JSON.stringify({cache, pictures: pictures.checked})}`, problem);
  function recommend(said) {
    key = newKey();  // another question about the same text
    return send('/v1/recommendations', `"recommend": ${JSON.stringify({error: asks.error(), budget: asks.seconds()})}, "options": ${JSON.stringify({cache})}`, said);
  }
  const pictures = h('input', {type: 'checkbox', checked: true, id: 'pictures', onchange: () => { key = newKey(); }});
  const button = h('button', {type: 'submit', class: 'primary', id: 'run'}, 'Run it');
  const examples = h('span', {class: 'choices'});
  const purpose = h('p', {class: 'note', id: 'purpose'});
  let pick = () => {}, first = null;

  async function load() {
    if (draft) edit.set(draft);
    const {scenarios} = await get('/v1/scenarios', signal);
    pick = (name) => {
      const example = scenarios.find((s) => s.name === name);
      if (!example) return;
      examples.querySelector('select').value = name;
      setText(purpose, example.purpose ?? '');
      edit.set(written(example.document));
    };
    first = scenarios.find((s) => s.name === 'quickstart') ?? scenarios[0] ?? null;
    if (!first) head?.withoutExamples();
    const kept = draft ?? sessionStorage.getItem(draftKey);
    examples.replaceChildren(choice('Example', [{value: '', text: 'your own'}, ...scenarios.map((s) => ({value: s.name, text: s.name}))],
      kept ? '' : first?.name, (name) => pick(name)));
    if (kept) { if (!draft) edit.set(kept); } else if (first) pick(first.name);
  }

  const title = draft ? h('h1', {tabindex: '-1'}, 'Run a scenario') : h('h2', {tabindex: '-1'}, 'Run a scenario');
  const bring = (text) => { own(); edit.set(text); title.scrollIntoView(); button.focus({preventScroll: true}); };
  const picker = draft ? null : filePicker({taken: bring, signal});
  const head = draft ? null : startHead({
    compare() { pick(first?.name); title.scrollIntoView(); button.focus({preventScroll: true}); },
    files: picker.element, recommend: () => recommend(asked), said: asked, error: asks.errors[0], time: asks.minutes[0],
  });
  load().catch((error) => { if (!signal.aborted) setText(problem, error.message); });
  const element = h('div', {class: 'stack'}, head?.element,
    h('form', {class: 'submit', onsubmit: (event) => { event.preventDefault(); run(); }},
      h('div', {class: 'page-head'}, title, examples),
      purpose,
      h('div', {class: 'workbench'}, form.element,
        h('div', {class: 'text-side'}, h('label', {class: 'hidden', for: 'scenario'}, 'Scenario, as JSON'), edit.element, verdict)),
      h('div', {class: 'actions'}, button,
        h('span', {class: 'choices'}, h('button', {type: 'button', class: 'send', onclick: () => { if (asks.valid()) recommend(problem); }}, 'Recommend for this error'), asks.minutes[1]),
        h('label', {class: 'check'}, pictures, ' with pictures'),
        choice('Known results', [{value: 'reuse', text: 'reuse them'}, {value: 'fresh', text: 'measure again'}], cache, (v) => { cache = v; key = newKey(); })),
      problem));
  return element;
}
