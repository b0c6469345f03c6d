// The list of jobs, kept up to date.
import {address} from './address.js';
import {get, post, remove} from './api.js';
import {announce, choice, h, setText} from './dom.js';
import {bytes, moment, percent, seconds} from './format.js';
import {ended, pause, watchJob} from './watch.js';

const askAgain = 2500, typingPause = 250;  // milliseconds
const states = ['queued', 'running', 'succeeded', 'failed', 'cancelled'];
const signs = {queued: '○', running: '◐', succeeded: '●', failed: '✕', cancelled: '⊘'};

export function stateMark(job) {
  const broken = job.state === 'succeeded' && (job.promises_kept === false || job.reached === false);
  return h('span', {class: `state state-${broken ? 'broken' : job.state}`}, h('span', {'aria-hidden': 'true'}, broken ? '△' : signs[job.state]),
    ` ${!broken ? job.state : job.reached === false ? 'error not reached' : 'promise broken'}`);
}

// Places such as "1/2 key" count the lights of all variants.
function placeText(place) {
  const [, n, of, light] = /^(\d+)\/(\d+) (.+)$/.exec(place ?? '') ?? [];
  return n ? `light ${light} (${n} of ${of})` : place;
}

export function progressText(job) {
  if (job.state === 'queued') return job.position ? `${job.position} before it` : 'next';
  if (job.state === 'running') {
    const p = job.progress;
    if (!p) return 'starting';
    const time = job.kind === 'recommendation' && ['exploring', 'confirming'].includes(p.stage) && `${p.done} of ${p.total} s`;
    return `${percent(p.fraction)}: ${[p.stage, placeText(p.place), time].filter(Boolean).join(', ')}`;
  }
  if (job.state === 'failed') return job.error?.message ?? '';
  const time = (new Date(job.ended) - new Date(job.started)) / 1000;
  return job.cached ? 'from an earlier result' : Number.isFinite(time) && job.started ? seconds(time) : '';
}

export function progressBar(job) {
  return h('progress', {max: '1', value: String(job.progress?.fraction ?? 0), 'aria-label': `Progress of ${job.name}`});
}

// What tells a job from others of its scenario: its id, who sent it, its labels and what it keeps on the disk.
function detailsOf(job) {
  return [job.kind === 'recommendation' && 'recommendation', job.id, job.owner, ...(job.labels ?? []), job.bytes > 0 && bytes(job.bytes), job.pinned && 'pinned'].filter(Boolean).join(', ');
}

// act(job, what): 'delete', 'cancel', 'retry', 'pin' or 'unpin'.
function row(act) {
  const name = h('a', {}), state = h('td'), what = h('span'), bar = h('span', {class: 'bar'}), when = h('td', {class: 'when'});
  const button = h('button', {type: 'button', class: 'quiet', onclick: () => act(current, ended(current) ? 'delete' : 'cancel')});
  const again = h('button', {type: 'button', class: 'quiet', hidden: true, onclick: () => act(current, 'retry')}, 'Retry');
  const pin = h('button', {type: 'button', class: 'quiet', onclick: () => act(current, current.pinned ? 'unpin' : 'pin')});
  const element = h('tr', {}, h('th', {scope: 'row'}, name, h('small', {class: 'id'})), state, h('td', {class: 'what'}, bar, what), when, h('td', {class: 'act'}, h('div', {}, again, pin, button)));
  let current = null;
  return {
    element,
    update(job) {
      const before = current;
      current = job;
      name.href = `#/jobs/${job.id}`;
      setText(name, job.name || 'unnamed');
      setText(element.querySelector('.id'), detailsOf(job));
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
      pin.hidden = !ended(job);
      setText(pin, job.pinned ? 'Unpin' : 'Pin');
      pin.title = job.pinned ? 'It may be removed for its age or space again' : 'Keeps it, however old it gets and whatever space it takes';
      pin.setAttribute('aria-label', `${pin.textContent} ${job.name}, ${job.id}`);
      setText(button, ended(job) ? 'Delete' : 'Cancel');
      button.setAttribute('aria-label', `${ended(job) ? 'Delete' : 'Cancel'} ${job.name}, ${job.id}`);
    },
  };
}

export function jobsView({signal}) {
  const body = h('tbody'), problem = h('p', {class: 'problem', role: 'alert'}), empty = h('p', {class: 'empty', hidden: true});
  const rows = new Map(), watched = new Set();
  let state = '', words = '', cursors = [''], next = null, turn = 0, timer = 0;

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
    setText(empty, words ? `No ${state && `${state} `}job has this text.` : state ? `No job is ${state}.` : 'There are no jobs yet.');
    table.hidden = jobs.length === 0;
    more.hidden = !next;
  }
  async function refresh() {
    const mine = ++turn;
    const jobs = [];
    let after = null;
    try {
      for (const cursor of cursors) {
        const query = new URLSearchParams({limit: '50', ...(state && {state}), ...(words && {text: words}), ...(cursor && {cursor})});
        const page = await get(`/v1/jobs?${query}`, signal);
        jobs.push(...page.jobs);
        after = page.next;
      }
      if (mine !== turn) return;
      next = after;
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
  const filter = choice('State', [{value: '', text: 'all'}, ...states.map((s) => ({value: s, text: s}))], '', (v) => { address.go({state: v || null}); read(); refresh(); });
  const find = h('input', {type: 'search', title: 'A part of the name, id, owner, labels or fault', oninput: () => {
    address.keep({text: find.value.trim() || null});
    clearTimeout(timer);
    timer = setTimeout(() => { read(); refresh(); }, typingPause);
  }});
  // The address names what is listed.
  function read() {
    state = address.word('state', ['', ...states]);
    words = address.get('text') ?? '';
    cursors = [''];
    filter.querySelector('select').value = state;
    if (document.activeElement !== find) find.value = words;
  }
  read();
  addEventListener('hashchange', () => { read(); refresh(); }, {signal});
  signal.addEventListener('abort', () => clearTimeout(timer), {once: true});
  (async () => {
    for (;;) { await refresh(); await pause(askAgain, signal); }
  })().catch(() => {});
  return h('div', {class: 'stack'},
    h('div', {class: 'page-head'}, h('h1', {tabindex: '-1'}, 'Jobs'), h('div', {class: 'choices'}, h('a', {href: '#/compare'}, 'Compare two results'),
      h('label', {class: 'choice'}, h('span', {}, 'Find'), find), filter)),
    problem, h('div', {class: 'scroll panel flush'}, table, empty), more);
}
