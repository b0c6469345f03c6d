// One job: its progress, then its result.
import {get, getText, hasToken, objectUrl, post} from './api.js';
import {withPart} from './choices.js';
import {address} from './address.js';
import {announce, h, setText} from './dom.js';
import {moment, newKey, seconds, significant} from './format.js';
import {progressBar, progressText, stateMark} from './jobs.js';
import {recommendationParts, shownFirst} from './result/recommendation.js';
import {resultView, summaryOf} from './result/view.js';
import {ended, watchJob} from './watch.js';

function sourceOf(job) {
  const path = `/v1/jobs/${encodeURIComponent(job.id)}`;
  const urls = new Map();
  return {
    async picture(file, signal) {
      const address = `${path}/artifacts/images/${encodeURIComponent(file)}`;
      if (!hasToken()) return address;
      if (!urls.has(file)) urls.set(file, await objectUrl(address, signal));
      return urls.get(file);
    },
    // The points of a recommendation are not those of its scenario.
    curves: job.kind !== 'recommendation' && ((group, x, y, signal) =>
      get(`${path}/curves?${new URLSearchParams({light: String(group.lightIndex), x, y, variant: String(group.variant)})}`, signal)),
  };
}

// A link to a file of the job. A plain link could not carry the token.
function fileLink(text, address, name) {
  return h('a', {href: address, download: name, onclick: async (event) => {
    if (!hasToken() || event.currentTarget.href.startsWith('blob:')) return;
    event.preventDefault();
    const link = event.currentTarget;
    link.href = await objectUrl(address);
    link.click();
  }}, text);
}

// What a recommendation is asked for, in words.
function questionOf({kind, recommend}) {
  if (kind !== 'recommendation') return null;
  return ['recommendation', recommend?.error && `error at most ${significant(recommend.error)}`, recommend?.budget && `within ${seconds(recommend.budget)}`].filter(Boolean).join(', ');
}

function progressPanel(stop) {
  const bar = h('div', {class: 'bar wide'}), text = h('p', {class: 'stage-text', role: 'status'});
  const button = h('button', {type: 'button', class: 'quiet', onclick: stop}, 'Cancel');
  const element = h('section', {class: 'panel progress', 'aria-label': 'Progress'}, bar, h('div', {class: 'panel-head'}, text, button));
  return {
    element,
    update(job) {
      if (!bar.firstChild) bar.append(progressBar(job));
      bar.hidden = job.state === 'queued';
      if (job.state === 'running') bar.firstChild.value = job.progress?.fraction ?? 0;
      setText(text, job.state === 'queued' ? `Queued: ${progressText(job)}` : progressText(job));
    },
  };
}

// retry(): queues the job once more.
function faultPanel(job, retry) {
  const {where, message} = job.error ?? {};
  return h('section', {class: job.state === 'failed' ? 'panel ended fault' : 'panel ended', role: 'alert'}, h('h2', {}, job.state === 'failed' ? 'The job failed' : 'The job was cancelled'),
    job.error && h('p', {}, where && h('code', {}, where), ` ${message}`),
    job.attempts > 1 && h('p', {class: 'note'}, `After ${job.attempts} attempts.`),
    h('p', {class: 'fault-actions'}, h('button', {type: 'button', onclick: retry}, 'Retry')));
}

export function jobView({id, signal, edit}) {
  const path = `/v1/jobs/${encodeURIComponent(id)}`;
  const title = h('h1', {tabindex: '-1'}, '…'), state = h('span'), facts = h('p', {class: 'note'}), links = h('p', {class: 'links'});
  const place = h('div', {class: 'stack'}), problem = h('p', {class: 'problem', role: 'alert'});
  const element = h('div', {class: 'stack'}, h('div', {class: 'page-head'}, h('div', {class: 'title'}, title, state), links), facts, problem, place);
  const failed = (error) => { if (!signal.aborted) setText(problem, error.message); };
  const lost = (error) => {
    if (signal.aborted || error.status !== 404) return failed(error);
    setText(title, 'No such job');
    setText(problem, `There is no job ${id}, or it was deleted.`);
    return place.replaceChildren(h('p', {}, h('a', {href: '#/jobs'}, 'All jobs')));
  };
  const progress = progressPanel(() => post(`${path}/cancel`, null).catch(failed));
  let shown = '', current = null;

  const retry = async () => {
    try {
      await post(`${path}/retry`, null, {}, signal);
      setText(problem, '');
      follow();
    } catch (error) {
      failed(error);
    }
  };
  // What was asked for goes along.
  const askedFor = () => ({error: current?.recommend?.error ?? ((address.get('error') ?? 'lookup.rms') === 'lookup.rms' ? address.get('budget') : null), within: Number.isInteger(current?.recommend?.budget / 60) ? current.recommend.budget / 60 : null});
  const take = (part) => get(`${path}/scenario`, signal).then((scenario) => edit(withPart(scenario, part), askedFor()), failed);
  const again = h('button', {type: 'button', class: 'link', onclick: () => get(`${path}/scenario`, signal).then((scenario) => edit(scenario, askedFor()), failed)}, 'Edit and run again');
  // The same question with more time. The scenario is sent as it is written, with all digits of its numbers.
  let asking = false;
  const askAgain = async (time) => {
    if (asking) return;
    asking = true;
    try {
      const scenario = await getText(`${path}/scenario`, signal);
      const job = await post('/v1/recommendations', `{"scenario": ${scenario}, "recommend": ${JSON.stringify({...current.recommend, budget: time})}}`, {'Idempotency-Key': newKey()}, signal);
      location.hash = `#/jobs/${job.id}`;
    } catch (error) {
      failed(error);
    } finally {
      asking = false;
    }
  };

  async function showResult(job) {
    const source = sourceOf(job);
    const has = (name) => job.artifacts?.includes(name);
    const described = (name) => (has(name) ? get(`${path}/artifacts/${name}`, signal) : null);
    const answer = job.kind === 'recommendation' && has('table.txt') ? getText(`${path}/artifacts/table.txt`, signal) : null;
    const [result, images, fault, text] = await Promise.all([
      get(`${path}/result`, signal), described('images/images.json'), described('images/error.json'), answer]);
    links.replaceChildren(fileLink('JSON', `${path}/result`, `${job.name}.json`), fileLink('CSV', `${path}/result.csv`, `${job.name}.csv`),
      fileLink('Offline report', `${path}/report`, `${job.name}.html`),
      h('a', {href: `#/compare/${encodeURIComponent(id)}`}, 'Compare with another'), again);
    place.replaceChildren(h('p', {class: 'purpose'}, result.purpose ?? ''),
      ...recommendationParts({result, text, name: job.name, take, askAgain, signal}),
      resultView({source, result, images, imagesFault: fault?.error, ...shownFirst(result), signal}), h('section', {class: 'panel quiet-panel', 'aria-label': 'Summary'}, summaryOf(result)));
    announce(`${job.name}: the result is shown`);
  }
  function update(job) {
    current = job;
    setText(title, job.name || 'unnamed');
    document.title = `${job.name} · shadowbench`;
    setText(facts, [questionOf(job), job.id, `sent ${moment(job.created)}${job.owner ? ` by ${job.owner}` : ''}`, ...(job.labels ?? []), `seed ${job.seed}`, job.cached && 'answered from an earlier result'].filter(Boolean).join(' · '));
    if (shown !== job.state) {
      state.replaceChildren(stateMark(job));
      if (!ended(job)) { if (!progress.element.isConnected) place.replaceChildren(progress.element); links.replaceChildren(again); }
      else if (job.state === 'succeeded') showResult(job).catch(failed);
      else { place.replaceChildren(faultPanel(job, retry)); links.replaceChildren(again); }
      shown = job.state;
    }
    if (!ended(job)) progress.update(job);
  }
  const follow = () => watchJob(id, update, signal).catch(lost);
  follow();
  return element;
}
