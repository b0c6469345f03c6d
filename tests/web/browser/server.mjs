// Something to open the page from: the mock, the program's own server, or one that runs already.
import assert from 'node:assert/strict';
import {execFileSync, spawn} from 'node:child_process';
import {existsSync, mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {setTimeout as pause} from 'node:timers/promises';
import {deadline, temporaryFolder} from './harness.mjs';
import {Mock, scenarioFrom} from './mock.mjs';

// A finished run of small.json with its pictures, as a folder of a job has them, and the table that run printed.
export function makeFixture({program, here}) {
  const folder = temporaryFolder('fixture');
  const scenario = join(here, 'small.json');
  writeFileSync(join(folder, 'table.txt'), execFileSync(program, ['run', scenario, '--out', folder], {stdio: ['ignore', 'pipe', 'ignore']}));
  execFileSync(program, ['render', scenario, '--out', join(folder, 'images')], {stdio: 'ignore'});
  return folder;
}

export async function startMock(options) {
  const scenarios = ['quickstart.json', 'hairball.json'].map((name) => scenarioFrom(join(options.scenarios, name)));
  const mock = new Mock(options.pages, options.fixture ?? makeFixture(options), scenarios);
  return {mock, url: await mock.start(), stop: async () => mock.stop()};
}

async function startReal({program, scenarios}) {
  const state = temporaryFolder('state'), portFile = join(state, 'port');
  mkdirSync(join(state, 'jobs'));
  const child = spawn(program, ['serve', '--port', '0', '--port-file', portFile, '--state', join(state, 'jobs'), '--data', scenarios],
    {stdio: ['ignore', 'ignore', 'pipe'], env: {...process.env, SHADOWBENCH_SCENARIOS: scenarios}});
  let said = '';
  child.stderr.on('data', (text) => { said += text; });
  const ended = new Promise((resolve) => { child.on('exit', resolve); });
  const port = () => (existsSync(portFile) ? readFileSync(portFile, 'utf8').trim() : '');
  for (const start = Date.now(); !port(); await pause(20)) {
    assert.equal(child.exitCode, null, `serve ended: ${said}`);
    assert.ok(Date.now() - start < deadline, `serve told no port: ${said}`);
  }
  return {mock: null, url: `http://127.0.0.1:${port()}/`, stop: async () => { child.kill('SIGTERM'); await ended; }};
}

export async function startServer(options) {
  if (options.server === 'mock') return startMock(options);
  if (options.server === 'real') return startReal(options);
  return {mock: null, url: options.server, stop: async () => {}};
}
