// The list of jobs, kept up to date.
import {get, post, remove} from './api.js';
import {announce, choice, h, setText} from './dom.js';
import {moment, percent, seconds} from './format.js';
import {ended, pause, watchJob} from './watch.js';

const askAgain = 2500;  // milliseconds
const states = ['queued', 'running', 'succeeded', 'failed', 'cancelled'];
const signs = {queued: '○', running: '◐', succeeded: '●', failed: '✕', cancelled: '–'};

export function stateMark(job) {
  const broken = job.state === 'succeeded' && (job.promises_kept === false || job.reached === false);
  return h('span', {class: `state state-${broken ? 'broken' : job.state}`}, h('span', {'aria-hidden': 'true'}, broken ? '△' : signs[job.state]),
    ` ${!broken ? job.state : job.reached === false ? 'error not reached' : 'promise broken'}`);
}

export function progressText(job) {
  if (job.state === 'queued') return job.position ? `${job.position} before it` : 'next';
  if (job.state === 'running') {
    const p = job.progress;
    return p ? `${percent(p.fraction)}  ${[p.stage, p.place].filter(Boolean).join(' ')}` : 'starting';
  }
  if (job.state === 'failed') return job.error?.message ?? '';
  const time = (new Date(job.ended) - new Date(job.started)) / 1000;
  return job.cached ? 'from an earlier result' : Number.isFinite(time) && job.started ? seconds(time) : '';
}

export function progressBar(job) {
  return h('progress', {max: '1', value: String(job.progress?.fraction ?? 0), 'aria-label': `Progress of ${job.name}`});
}

// act(job, what): 'delete', 'cancel' or 'retry'.
function row(act) {
  const name = h('a', {}), state = h('td'), what = h('span'), bar = h('span', {class: 'bar'}), when = h('td', {class: 'when'});
  const button = h('button', {type: 'button', class: 'quiet', onclick: () => act(current, ended(current) ? 'delete' : 'cancel')});
  const again = h('button', {type: 'button', class: 'quiet', hidden: true, onclick: () => act(current, 'retry')}, 'Retry');
  const element = h('tr', {}, h('th', {scope: 'row'}, name, h('small', {class: 'id'})), state, h('td', {class: 'what'}, bar, what), when, h('td', {class: 'act'}, again, ' ', button));
  let current = null;
  return {
    element,
    update(job) {
      const before = current;
      current = job;
      name.href = `#/jobs/${job.id}`;
      setText(name, job.name || 'unnamed');
      setText(element.querySelector('.id'), job.kind === 'recommendation' ? `recommendation, ${job.id}` : job.id);
      if (before?.state !== job.state || before?.promises_kept !== job.promises_kept || before?.reached !== job.reached) {
        state.replaceChildren(stateMark(job));
        if (before) announce(`${job.name}: ${job.state}`);
      }
      const running = job.state === 'running';
      if (running && !bar.firstChild) bar.append(progressBar(job));
      if (!running) bar.replaceChildren();
      else bar.firstChild.value = job.progress?.fraction ?? 0;
      setText(what, progressText(job));
      setText(when, moment(job.created));
      again.hidden = !(job.state === 'failed' || job.state === 'cancelled');
      again.setAttribute('aria-label', `Retry ${job.name}, ${job.id}`);
      setText(button, ended(job) ? 'Delete' : 'Cancel');
      button.setAttribute('aria-label', `${ended(job) ? 'Delete' : 'Cancel'} ${job.name}, ${job.id}`);
    },
  };
}

export function jobsView({signal}) {
  const body = h('tbody'), problem = h('p', {class: 'problem', role: 'alert'}), empty = h('p', {class: 'empty', hidden: true});
  const rows = new Map(), watched = new Set();
  let state = '', cursors = [''], next = null, turn = 0;

  const act = async (job, what) => {
    const path = `/v1/jobs/${encodeURIComponent(job.id)}`;
    try {
      if (what === 'delete') await remove(path);
      else await post(`${path}/${what}`, null);
      setText(problem, '');
    } catch (error) {
      setText(problem, error.message);
    }
    refresh();
  };
  function watch(job) {
    if (watched.has(job.id)) return;
    watched.add(job.id);
    watchJob(job.id, (now) => rows.get(now.id)?.update(now), signal).catch(() => {}).finally(() => {
      watched.delete(job.id);
      if (!signal.aborted) refresh();
    });
  }
  function draw(jobs) {
    const seen = new Set(jobs.map((job) => job.id));
    for (const [id, old] of rows) if (!seen.has(id)) { old.element.remove(); rows.delete(id); }
    jobs.forEach((job, i) => {
      if (!rows.has(job.id)) rows.set(job.id, row(act));
      const {element, update} = rows.get(job.id);
      update(job);
      if (body.children[i] !== element) body.insertBefore(element, body.children[i] ?? null);
      if (job.state === 'running') watch(job);
    });
    empty.hidden = jobs.length > 0;
    setText(empty, state ? `No job is ${state}.` : 'There are no jobs yet.');
    table.hidden = jobs.length === 0;
    more.hidden = !next;
  }
  async function refresh() {
    const mine = ++turn;
    const jobs = [];
    try {
      for (const cursor of cursors) {
        const query = new URLSearchParams({limit: '50', ...(state && {state}), ...(cursor && {cursor})});
        const page = await get(`/v1/jobs?${query}`, signal);
        jobs.push(...page.jobs);
        next = page.next;
      }
      if (mine !== turn) return;
      if (problem.dataset.lost) setText(problem, '');
      delete problem.dataset.lost;
      draw(jobs);
    } catch (error) {
      if (signal.aborted) return;
      problem.dataset.lost = 'true';
      setText(problem, error.message);
    }
  }
  const more = h('button', {type: 'button', class: 'quiet', hidden: true, onclick: () => { cursors = [...cursors, next]; refresh(); }}, 'Show older jobs');
  const table = h('table', {class: 'jobs', hidden: true}, h('caption', {class: 'hidden'}, 'Jobs, the newest first'),
    h('thead', {}, h('tr', {}, ['Scenario', 'State', 'Progress', 'Sent'].map((t) => h('th', {scope: 'col'}, t)), h('th', {scope: 'col'}, h('span', {class: 'hidden'}, 'Action')))), body);
  (async () => {
    for (;;) { await refresh(); await pause(askAgain, signal); }
  })().catch(() => {});
  return h('div', {class: 'stack'},
    h('div', {class: 'page-head'}, h('h1', {tabindex: '-1'}, 'Jobs'), h('div', {class: 'choices'}, h('a', {href: '#/compare'}, 'Compare two results'),
      choice('State', [{value: '', text: 'all'}, ...states.map((s) => ({value: s, text: s}))], '', (v) => { state = v; cursors = ['']; refresh(); }))),
    problem, h('div', {class: 'scroll panel flush'}, table, empty), more);
}
