// Compares two results, each of a job or a file: every measure gets a verdict.
import {get, post} from './api.js';
import {announce, choice, download, h, setText} from './dom.js';
import {bytes, csvOf, moment, significant} from './format.js';
import {verdictMark} from './result/table.js';

const sides = [['baseline', 'Baseline'], ['current', 'Current']];
const settled = new Set(['same', 'inconclusive']);  // verdicts that need no attention

async function finishedJobs(ids, signal) {
  const {jobs} = await get('/v1/jobs?state=succeeded&limit=100', signal);
  const missing = ids.filter((id) => id && !jobs.some((job) => job.id === id));
  return [...jobs, ...await Promise.all(missing.map((id) => get(`/v1/jobs/${encodeURIComponent(id)}`, signal)))];
}

function changeOf({time, reason}) {
  const ratio = time && `× ${significant(time.ratio)}, 95 %: ${significant(time.interval95[0])} to ${significant(time.interval95[1])}`;
  return [ratio, reason].filter(Boolean).join('; ');
}

function lineTable(lines) {
  const heads = [['Cell'], ['Measure'], ['Verdict'], ['Baseline', 'number'], ['Current', 'number'], ['Change']];
  const number = (value, {unit, measure}) => h('td', {class: 'number'}, value !== null && /bytes$/.test(measure) ? bytes(value, 4)
    : [significant(value, 5), value !== null && unit && h('small', {}, ` ${unit.replace(/^x /, '× ')}`)]);
  return h('div', {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Table of verdicts'},
    h('table', {class: 'cells lines'}, h('caption', {class: 'hidden'}, 'Every measure of every technique, those that need attention first'),
      h('thead', {}, h('tr', {}, heads.map(([text, kind]) => h('th', {scope: 'col', class: kind}, text)))),
      h('tbody', {}, lines.map((line) => h('tr', {}, h('th', {scope: 'row'}, line.title), h('td', {}, line.measure || 'all'), h('td', {}, verdictMark(line)),
        number(line.baseline, line), number(line.current, line), h('td', {class: 'change'}, changeOf(line)))))));
}

// All verdicts, with all digits.
function rowsOf(lines) {
  return [['cell', 'measure', 'verdict', 'baseline', 'current', 'unit', 'change'],
    ...lines.map((line) => [line.title, line.measure || 'all', line.verdict, line.baseline, line.current, line.unit, changeOf(line)])];
}

const upper = (text) => text.slice(0, 1).toUpperCase() + text.slice(1);

const ended = (text) => text.replace(/\.?$/, '.');

// The outcome without the exit code of the command line.
function outcomeOf(answer) {
  return answer.outcome.replace(/^exit code \d+: /, '');
}

function answerView(answer) {
  const place = h('div'), counts = Object.entries(answer.counts), outcome = outcomeOf(answer);
  const differ = answer.lines.filter((line) => !settled.has(line.verdict));
  const show = (wanted) => {
    const lines = wanted === 'all' ? answer.lines : wanted === 'differ' ? differ : answer.lines.filter((line) => line.verdict === wanted);
    place.replaceChildren(lines.length ? lineTable(lines) : h('p', {class: 'empty'}, 'No measure differs beyond its tolerance.'));
  };
  show('differ');
  const csv = () => download('verdicts.csv', 'text/csv', csvOf(rowsOf(answer.lines)));
  return h('section', {class: 'panel', 'aria-labelledby': 'verdicts-title'},
    h('div', {class: 'panel-head'}, h('h2', {id: 'verdicts-title'}, 'Verdicts'),
      h('div', {class: 'choices'}, h('button', {type: 'button', class: 'quiet small', 'aria-label': 'Save the verdicts as CSV', onclick: csv}, 'CSV'), choice('Show', [{value: 'differ', text: `what differs (${differ.length})`}, {value: 'all', text: `all (${answer.lines.length})`},
        ...counts.map(([verdict, n]) => ({value: verdict, text: `${verdict} (${n})`}))], 'differ', show))),
    h('p', {class: `outcome ${answer.exit_code ? 'bad-title' : 'good'}`}, `${upper(outcome)}.`),
    h('p', {}, `${counts.map(([verdict, n]) => `${n} ${verdict}`).join(', ')}.`),
    h('p', {class: 'note'}, upper([answer.method, answer.sensitivity].filter(Boolean).join('; '))),
    answer.notes.map((note) => h('p', {class: 'note'}, note)),
    answer.fronts.length > 0 && [h('h3', {class: 'part'}, 'Fronts'), h('ul', {class: 'fronts'}, answer.fronts.map((front) => h('li', {}, front.text)))],
    place);
}

// Picks one of the two results: a job, or a file that is chosen or dropped. Calls changed({job}) or changed({name, text}).
function sidePicker(label, jobs, id, changed, failed) {
  const said = h('p', {class: 'note'});
  const take = async (file) => {
    const text = await file.text();
    try {
      JSON.parse(text);
    } catch {
      return failed(`${file.name} is not JSON.`);
    }
    setText(said, `From the file ${file.name}.`);
    select.value = '';
    return changed({name: file.name, text});
  };
  const file = h('input', {type: 'file', accept: '.json,application/json', 'aria-label': `${label}: result.json of a run`, onchange: () => { if (file.files[0]) take(file.files[0]); }});
  const job = choice('Job', [{value: '', text: '…'}, ...jobs.map((j) => ({value: j.id, text: `${j.name}, ${moment(j.created)}, ${j.id}`}))], id ?? '', (value) => {
    setText(said, '');
    file.value = '';
    changed(value ? {job: value} : null);
  });
  const select = job.querySelector('select');
  return h('fieldset', {class: 'side', ondragover: (event) => event.preventDefault(), ondrop: (event) => {
    event.preventDefault();
    const {files} = event.dataTransfer;
    if (!files[0]) return;
    file.files = files;
    take(files[0]);
  }}, h('legend', {}, label), job, h('label', {class: 'choice'}, h('span', {}, 'or a result.json'), file), said);
}

// ids: the jobs that are chosen first, [baseline, current]; both are optional.
export function comparisonView({ids, signal}) {
  const problem = h('p', {class: 'problem', role: 'alert'}), place = h('div'), pickers = h('div', {class: 'pair'});
  const chosen = {baseline: ids[0] ? {job: ids[0]} : null, current: ids[1] ? {job: ids[1]} : null};
  let turn = 0;
  const failed = (text) => { place.replaceChildren(); setText(problem, text); };

  async function draw() {
    const mine = ++turn;
    setText(problem, '');
    if (!chosen.baseline || !chosen.current) return place.replaceChildren(h('p', {class: 'empty'}, 'Choose two results: jobs that have succeeded, or files. Files can be dropped here.'));
    // The text of a file is sent unchanged: parsing and writing it would lose digits of long numbers.
    const parts = sides.map(([side]) => `"${side}": ${chosen[side].job ? JSON.stringify({job: chosen[side].job}) : `{"result": ${chosen[side].text}}`}`);
    try {
      const answer = await post('/v1/compare', `{${parts.join(', ')}}`, {}, signal);
      if (mine !== turn) return;
      place.replaceChildren(answerView(answer));
      announce(outcomeOf(answer));
    } catch (error) {
      if (!signal.aborted && mine === turn) failed(error.errors?.length ? error.errors.map(sentence).join(' ') : error.message);
    }
  }
  // A fault of a side names it and its file in words.
  function sentence({pointer, detail}) {
    const [side, label] = sides.find(([name]) => pointer === `/${name}` || pointer?.startsWith(`/${name}/`)) ?? [];
    return side ? `${label}: ${chosen[side].name ?? chosen[side].job}: ${ended(detail)}` : `${pointer} ${ended(detail)}`;
  }
  function pick(side, what) {
    chosen[side] = what;
    history.replaceState(null, '', ['#/compare', ...sides.map(([s]) => encodeURIComponent(chosen[s]?.job ?? ''))].join('/').replace(/\/+$/, ''));
    draw();
  }
  finishedJobs(ids, signal).then((jobs) => pickers.replaceChildren(...sides.map(([side, label], i) => sidePicker(label, jobs, ids[i], (what) => pick(side, what), failed))),
    (error) => { if (!signal.aborted) setText(problem, error.message); });
  draw();
  return h('div', {class: 'stack'}, h('div', {class: 'page-head'}, h('h1', {tabindex: '-1'}, 'Compare two results')),
    h('p', {class: 'purpose'}, 'Bytes, nodes, errors and promises are the same on every machine and are judged by tolerance. Times of two single runs decide nothing; ', h('code', {}, 'shadowbench ab'), ' judges times.'),
    h('section', {class: 'panel', 'aria-label': 'The two results'}, pickers, problem), place);
}
