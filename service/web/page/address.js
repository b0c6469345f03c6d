// What a page shows, in its address: #/jobs/<id>?technique=3&pixel=45,40. A reload, Back and a link then show the same.

// The address without its state. A report has none, which is "" or "#".
export function pathOf(hash) {
  return hash.split('?', 1)[0] || '#';
}

export function stateOf(hash) {
  const at = hash.indexOf('?');
  return new URLSearchParams(at < 0 ? '' : hash.slice(at + 1));
}

// The address with changes {name: value}; a value that is null is left out.
export function changed(hash, changes) {
  const state = stateOf(hash);
  for (const [name, value] of Object.entries(changes)) value === null ? state.delete(name) : state.set(name, String(value));
  const text = state.toString().replaceAll('%2C', ',');
  return pathOf(hash) + (text && `?${text}`);
}

// n finite numbers of a state such as "45,40", or nothing.
export function numbersOf(text, n) {
  const numbers = (text ?? '').split(',').map((part) => (part.trim() === '' ? NaN : Number(part)));
  return numbers.length === n && numbers.every(Number.isFinite) ? numbers : null;
}

// Browsers refuse addresses that change too often: Safari more than 100 times in 30 s.
const pause = 300;  // milliseconds
let waiting = null, before = '', last = 0, timer = 0;

function write(changes, how) {
  const next = changed(location.hash, changes);
  if (next !== (location.hash || '#')) history[how](null, '', next);
}

// Writes what waits, unless the page shows something else by now.
function flush() {
  const changes = waiting;
  clearTimeout(timer);
  timer = 0;
  waiting = null;
  if (!changes || location.hash !== before) return;
  last = Date.now();
  write(changes, 'replaceState');
}

// The state of the page that is shown.
export const address = {
  get(name) {
    flush();
    return stateOf(location.hash).get(name);
  },
  numbers: (name, n) => numbersOf(address.get(name), n),
  // One of the values, or the first of them.
  word: (name, values) => (values.includes(address.get(name)) ? address.get(name) : values[0]),
  // Steps that Back undoes.
  go(changes) {
    flush();
    write(changes, 'pushState');
  },
  // What moves all the time, such as a slider: the address follows after a moment.
  keep(changes) {
    if (location.hash !== before) waiting = null;
    before = location.hash;
    waiting = {...waiting, ...changes};
    const left = last + pause - Date.now();
    if (left <= 0) flush();
    else timer ||= setTimeout(flush, left);
  },
};
