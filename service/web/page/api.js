// Sends requests to the server. A token, if the server requires one, is kept in this tab.

const tokenKey = 'shadowbench-token';
let asking = null;
let askToken = null;

// ask() shows a form and returns a promise of the token.
export function onTokenNeeded(ask) {
  askToken = ask;
}

export function hasToken() {
  return sessionStorage.getItem(tokenKey) !== null;
}

// A problem of RFC 9457. `status` 0: the server did not answer.
export class Problem extends Error {
  constructor(status, body, retryAfter) {
    // Whoever runs the server finds a fault of its own by this.
    const id = status >= 500 && body.request_id ? ` Request ${body.request_id}.` : '';
    super(`${body.detail || body.title || `The server answered ${status}.`}${id}`);
    this.status = status;
    this.errors = body.errors ?? [];
    this.retryAfter = retryAfter;
  }
}

async function send(path, options) {
  const token = sessionStorage.getItem(tokenKey);
  const headers = {...options.headers, ...(token && {Authorization: `Bearer ${token}`})};
  try {
    return await fetch(path, {...options, headers, cache: 'no-cache'});
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new Problem(0, {detail: 'The server does not answer. Is it still running?'});
  }
}

async function answer(path, options = {}) {
  for (;;) {
    const response = await send(path, options);
    if (response.ok) return response;
    if (response.status === 401 && askToken) {
      asking ??= askToken(hasToken()).finally(() => { asking = null; });
      sessionStorage.setItem(tokenKey, await asking);
      continue;
    }
    const body = await response.json().catch(() => ({}));
    throw new Problem(response.status, body, Number(response.headers.get('Retry-After')) || null);
  }
}

export async function get(path, signal) {
  return (await answer(path, {signal})).json();
}

export async function getText(path, signal) {
  return (await answer(path, {signal})).text();
}

// `json` is text, since parsing and writing it would lose digits of long numbers; null: no body.
export async function post(path, json, headers = {}, signal) {
  const type = json !== null && {'Content-Type': 'application/json'};
  return (await answer(path, {method: 'POST', headers: {...type, ...headers}, body: json, signal})).json();
}

export async function remove(path) {
  await answer(path, {method: 'DELETE'});
}

// A link cannot carry the token, so its target is fetched.
export async function objectUrl(path, signal) {
  return URL.createObjectURL(await (await answer(path, {signal})).blob());
}

// The messages of a stream of events, as {id, event, data}. Uses fetch, since EventSource cannot carry the token.
export async function* events(path, lastId, signal) {
  const response = await answer(path, {
    signal, headers: {Accept: 'text/event-stream', ...(lastId && {'Last-Event-ID': lastId})},
  });
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = '';
  for (;;) {
    const {value, done} = await reader.read();
    if (done) return;
    text += value;
    const messages = text.split(/\r?\n\r?\n/);
    text = messages.pop();
    for (const message of messages) {
      const fields = {id: '', event: 'message', data: ''};
      for (const line of message.split(/\r?\n/)) {
        const [, name, content] = /^([a-z]+): ?(.*)$/.exec(line) ?? [];
        if (name === 'data') fields.data += content;
        else if (name) fields[name] = content;
      }
      if (fields.data) yield fields;
    }
  }
}
