// A server with the API's answers and no engine behind it, for states that a real one seldom has: no answer, a full
// queue, a token, no jobs at all, a failed job. Finished jobs have the result of a real run, from `fixture`.
import {createReadStream, existsSync, readdirSync, readFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {join, normalize} from 'node:path';

const policy = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; " +
  "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const types = {html: 'text/html; charset=utf-8', js: 'text/javascript', css: 'text/css', svg: 'image/svg+xml', webp: 'image/webp', png: 'image/png', json: 'application/json'};
const stages = ['capture', 'build', 'lookup', 'reference', 'pictures'];

function stepCurve(at, value) {
  return {z: [at, at], v: [1, value]};
}

// The paper's cases: a step, and a medium, which is a slope. The second light's map is coloured.
function curvesOf(light, x, y) {
  const exact = {z: [2, 2, 2.6, 3.4, 3.4], v: [1, 0.8, 0.45, 0.35, 0.1 + 0.005 * x]};
  if (light === '1') {
    const z = [2, 2], v = [1, 0.9], colours = {channels: [v, [1, 0.5], [1, 0.1]], channels_z: [z, [2.5, 2.5], z]};
    return {light, x, y, z_min: 1, z_max: 4, rays: 16, exact: {z, v, ...colours},
      curves: [{title: 'deep tolerance=0.01', technique: 'deep', z, v, ...colours, nodes: 6, error_max: 0}]};
  }
  return {
    light, x, y, z_min: 1, z_max: 4, rays: 16, exact,
    curves: [
      {title: 'shadow_map', technique: 'shadow_map', ...stepCurve(2, 0), nodes: 1, error_max: 0.8},
      {title: 'deep tolerance=0.01', technique: 'deep', z: [2, 2, 2.7, 3.4, 3.4], v: [1, 0.79, 0.44, 0.34, 0.1 + 0.005 * x], nodes: 5, error_max: 0.01},
      {title: 'avsm nodes=4', technique: 'avsm', z: [2, 2, 3.4, 3.4], v: [1, 0.7, 0.7, 0.12], nodes: 4, error_max: 0.31},
      {title: 'ray_traced', technique: 'ray_traced', absent: 'stores no function'},
    ],
  };
}

// What the server says of two results that differ in everything that they can.
function comparison() {
  const line = (cell, measure, verdict, baseline, current, unit, reason, time = null) => ({title: `small / key / ${cell}`, suite: 'small', group: 'key', cell, measure, verdict,
    code: {larger: 2, 'less accurate': 2, missing: 2, 'not comparable': 2, slower: 1}[verdict] ?? 0, unit, baseline, current, reason, command: null, time});
  const lines = [
    line('avsm nodes=4', 'lookup_error.rms', 'less accurate', 0.0721, 0.0854, '', '+0.0133 (+18.4 %)'),
    line('deep tolerance=0.01', 'bytes', 'larger', 40000, 48400, '', '+8400 (+21 %)'),
    line('fourier', '', 'missing', null, null, '', '<b>not</b> in the current side'),
    line('deep tolerance=0.01', 'lookup_random', 'slower', 8.1, 9.9, 'x floor', '', {ratio: 1.22, interval95: [1.17, 1.29], processes: 20, p_slower: 1e-5, p_faster: 1, looks_slower: true}),
    line('shadow_map', 'lookup_image', 'not comparable', 6.6, 6.4, 'x floor', 'another machine'),
    line('avsm nodes=4', 'build', 'inconclusive', 0.0606, 0.0607, 'ms', 'fewer than 4 processes a side decide nothing', {ratio: 1.0016, interval95: [0.975, 1.186], processes: 1, p_slower: 1, p_faster: 1, looks_slower: false}),
    line('avsm nodes=4', 'lookup_error.max', 'more accurate', 0.31, 0.24, '', ''),
    line('shadow_map', 'working_bytes', 'smaller', 16384, 8192, '', ''),
    line('uncompressed', 'lookup_error.rms', 'same', 0.069, 0.069, '', ''),
  ];
  const counts = {};
  for (const {verdict} of lines) counts[verdict] = (counts[verdict] ?? 0) + 1;
  return {schema_version: 1, baseline: '', current: '', exit_code: 2, outcome: 'exit code 2: 3 measures are larger, less accurate or missing', interleaved: false, effect: 0.05,
    judged_times: 1, method: 'medians of processes, over the floor where there is one', sensitivity: '', counts, lines,
    fronts: [{suite: 'small', group: 'key', cell: 'avsm nodes=4', front: 'bytes and error', joined: false, by: ['fourier'], text: 'small / key / avsm nodes=4 left the front of bytes and error: fourier beats it'}],
    notes: ['The two sides are of different commits.']};
}

export class Mock {
  constructor(pages, fixture, scenarios) {
    Object.assign(this, {pages, fixture, scenarios, document: scenarios[0].document, jobs: [], token: null, refuse: null, keys: [], bodies: [], files: {}, asked: null, results: null, resultOf: new Map(),
      dataFiles: [{name: 'hair/ponytail.hair', bytes: 123456}, {name: 'smoke.vdb', bytes: 9 << 20}]});
    this.waiting = new Set();
    this.server = createServer((request, response) => this.answer(request, response).catch((error) => {
      response.writeHead(500).end(String(error));
    }));
  }

  async start() {
    await new Promise((resolve) => { this.server.listen(0, '127.0.0.1', resolve); });
    return `http://127.0.0.1:${this.server.address().port}/`;
  }

  stop() {
    this.server.closeAllConnections();
    this.server.close();
  }

  job(state, more = {}) {
    const id = `j-${String(this.jobs.length + 1).padStart(16, '0')}`;
    const now = '2026-11-25T02:03:04.123Z';
    const job = {
      id, state, name: 'small', scenario_hash: '9e9d87140e16f0a5', seed: 1, created: now, started: state === 'queued' ? null : now,
      ended: ['queued', 'running'].includes(state) ? null : '2026-11-25T02:03:09.500Z', attempts: 1, position: state === 'queued' ? 0 : null,
      progress: state === 'running' ? {stage: 'build', place: '1/2 key', done: 3, total: 16, fraction: 0.42} : null,
      kind: 'run', recommend: null, reached: null, cached: false, promises_kept: state === 'succeeded' ? true : null, error: null, owner: null, labels: [], priority: 0, pinned: false, bytes: state === 'succeeded' ? 3 << 19 : 0, artifacts: [], ...more,
    };
    if (job.state === 'succeeded') this.finish(job);
    this.jobs.unshift(job);
    return job;
  }

  finish(job) {
    const images = join(this.fixture, 'images');
    Object.assign(job, {state: 'succeeded', progress: null, promises_kept: true, ended: '2026-11-25T02:03:09.500Z',
      artifacts: ['result.json', 'result.csv', ...(existsSync(images) ? readdirSync(images).map((name) => `images/${name}`) : [])]});
  }

  // One step of what runs: the test says when.
  step(job) {
    if (job.state === 'queued') Object.assign(job, {state: 'running', position: null, started: job.created, progress: {stage: 'capture', place: '1/2 key', done: 0, total: 5, fraction: 0}});
    else if (job.progress.done + 1 < stages.length) {
      const done = job.progress.done + 1;
      job.progress = {stage: stages[done], place: '1/2 key', done, total: stages.length, fraction: done / stages.length};
    } else this.finish(job);
    for (const wake of this.waiting) wake();
  }

  json(response, status, body, headers = {}) {
    response.writeHead(status, {'Content-Type': status < 400 ? 'application/json' : 'application/problem+json', ...headers});
    response.end(body === undefined ? undefined : JSON.stringify(body));
  }

  problem(response, status, detail, more = {}, headers = {}) {
    this.json(response, status, {type: 'about:blank', title: 'No', status, detail, ...more}, headers);
  }

  file(response, path) {
    if (!existsSync(path)) return this.problem(response, 404, 'There is no such file.');
    response.writeHead(200, {'Content-Type': types[path.split('.').pop()] ?? 'application/octet-stream', 'Content-Security-Policy': policy});
    createReadStream(path).pipe(response);
  }

  async answer(request, response) {
    const url = new URL(request.url, 'http://x');
    const [, ...path] = url.pathname.split('/').map(decodeURIComponent);
    if (path[0] === '') return this.file(response, join(this.pages, 'index.html'));
    if (path[0] === 'assets') return this.file(response, join(this.pages, normalize(path[1])));
    if (this.token && request.headers.authorization !== `Bearer ${this.token}`) return this.problem(response, 401, 'A token is needed.');
    let text = '';
    for await (const part of request) text += part;
    const handler = {scenarios: this.getScenarios, techniques: this.getTechniques, files: this.getFiles, new: this.newScenario, recommendations: this.recommend, validate: this.validate, jobs: path[2] ? this.oneJob : this.allJobs, compare: this.compare}[path[1]];
    if (!handler) return this.problem(response, 404, 'There is no such file.');
    return handler.call(this, {request, response, url, path, text, body: text ? JSON.parse(text) : null});
  }

  getScenarios({response}) { this.json(response, 200, {scenarios: this.scenarios}); }

  getTechniques({response}) {
    const ids = ['shadow_map', 'pcf', 'deep', 'avsm', 'fourier', 'uncompressed', 'ray_traced'];
    this.json(response, 200, {techniques: ids.map((id) => ({id, title: `the technique ${id}`, parameters: []}))});
  }

  getFiles({response}) { this.json(response, 200, {files: this.dataFiles, more: this.dataFiles.length > 2}); }

  // A scenario around a file; one that ends with .bad cannot be read.
  newScenario({response, body}) {
    this.asked = body;
    if (body.files[0].endsWith('.bad')) return this.problem(response, 422, `${body.files[0]}: not a grid`, {errors: [{pointer: '/files/0', detail: 'not a grid'}]});
    return this.json(response, 200, {...this.document, name: body.files[0].split('/').pop()});
  }

  recommend({request, response, body}) {
    this.keys.push(request.headers['idempotency-key']);
    const job = this.job('queued', {name: body.scenario.name, scenario: body.scenario, kind: 'recommendation', recommend: body.recommend, options: body.options});
    return this.json(response, 202, job, {Location: `/v1/jobs/${job.id}`});
  }

  faults(scenario) {
    const errors = [];
    if (typeof scenario.rays?.samples_per_pixel !== 'number') errors.push({pointer: '/rays/samples_per_pixel', detail: 'not a number'});
    if (!scenario.techniques?.length) errors.push({pointer: '/techniques', detail: 'at least one technique is needed'});
    return errors;
  }

  validate({response, body}) {
    const errors = this.faults(body);
    if (errors.length) return this.problem(response, 422, 'The scenario is not valid.', {errors});
    return this.json(response, 200, {valid: true, name: body.name, variants: 2, lights: body.lights.length, techniques: body.techniques.length,
      notes: [], estimate: {seconds: 4.2, bytes: 3 << 20}});
  }

  allJobs({request, response, url, text, body}) {
    if (request.method === 'GET') {
      const state = url.searchParams.get('state'), limit = Number(url.searchParams.get('limit') ?? 50), from = Number(url.searchParams.get('cursor') ?? 0);
      const words = url.searchParams.get('text') ?? '';
      const fitting = this.jobs.filter((job) => (!state || job.state === state) && [job.id, job.name, job.owner ?? '', ...job.labels].some((each) => each.includes(words)));
      return this.json(response, 200, {jobs: fitting.slice(from, from + limit), next: from + limit < fitting.length ? String(from + limit) : null});
    }
    this.keys.push(request.headers['idempotency-key']);
    this.bodies.push(text);
    if (this.refuse) return this.problem(response, this.refuse.status, this.refuse.detail, {}, this.refuse.headers);
    const errors = this.faults(body.scenario);
    if (errors.length) return this.problem(response, 422, 'The scenario is not valid.', {errors});
    const job = this.job('queued', {name: body.scenario.name, scenario: body.scenario, options: body.options});
    return this.json(response, 202, job, {Location: `/v1/jobs/${job.id}`});
  }

  compare({response, text, body}) {
    this.compared = body;
    this.comparedText = text;
    if (body.current.result && !body.current.result.variants) return this.problem(response, 422, '/current: not a result of run', {errors: [{pointer: '/current', detail: 'not a result of run'}]});
    return this.json(response, 200, comparison());
  }

  oneJob({request, response, url, path, text}) {
    const job = this.jobs.find((j) => j.id === path[2]);
    if (!job) return this.problem(response, 404, 'There is no such job.');
    const part = path[3];
    if (request.method === 'DELETE') {
      this.jobs = this.jobs.filter((j) => j !== job);
      return response.writeHead(204).end();
    }
    if (!part) return this.json(response, 200, job);
    if (part === 'cancel') {
      if (text) return this.problem(response, 400, 'This request takes no body.');
      Object.assign(job, {state: 'cancelled', progress: null, position: null, ended: job.created});
      for (const wake of this.waiting) wake();
      return this.json(response, 202, job);
    }
    if (part === 'retry') {
      if (!['failed', 'cancelled'].includes(job.state)) return this.problem(response, 409, 'It has not failed.');
      Object.assign(job, {state: 'queued', position: 0, error: null, ended: null});
      return this.json(response, 202, job);
    }
    if (part === 'pin' || part === 'unpin') return this.json(response, 200, Object.assign(job, {pinned: part === 'pin'}));
    if (part === 'events') return this.events(request, response, job);
    if (part === 'scenario') return this.json(response, 200, job.scenario ?? this.document);
    if (part === 'result' && (this.resultOf.has(job.id) || this.results)) return this.json(response, 200, this.resultOf.get(job.id) ?? this.results);
    if (part === 'result') return this.file(response, join(this.fixture, 'result.json'));
    if (part === 'curves') return this.json(response, 200, curvesOf(url.searchParams.get('light'), Number(url.searchParams.get('x')), Number(url.searchParams.get('y'))));
    const name = path.slice(4).join('/');
    if (part === 'artifacts' && typeof this.files[name] === 'string') return response.writeHead(200, {'Content-Type': 'text/plain; charset=utf-8'}).end(this.files[name]);
    if (part === 'artifacts' && this.files[name]) return this.json(response, 200, this.files[name]);
    return part === 'artifacts' ? this.file(response, join(this.fixture, normalize(name))) : this.problem(response, 404, 'There is no such file.');
  }

  events(request, response, job) {
    response.writeHead(200, {'Content-Type': 'text/event-stream', 'Cache-Control': 'no-cache'});
    response.write(': heartbeat\n\n');
    let id = 0;
    const send = () => {
      const end = !['queued', 'running'].includes(job.state);
      response.write(`id: ${++id}\nevent: ${end ? 'end' : 'progress'}\ndata: ${JSON.stringify(job)}\n\n`);
      if (end) response.end();
    };
    this.waiting.add(send);
    request.on('close', () => this.waiting.delete(send));
    send();
  }
}

export function scenarioFrom(file) {
  const document = JSON.parse(readFileSync(file, 'utf8'));
  return {name: document.name, purpose: document.purpose, document};
}
