// What a page shows, in its address: #/jobs/<id>?technique=3&pixel=45,40. A reload, Back and a link then show the same.

// The address without its state.
export function pathOf(hash) {
  return hash.split('?', 1)[0];
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
  return (pathOf(hash) || '#') + (text && `?${text}`);
}

// n finite numbers of a state such as "45,40", or nothing.
export function numbersOf(text, n) {
  const numbers = (text ?? '').split(',').map((part) => (part.trim() === '' ? NaN : Number(part)));
  return numbers.length === n && numbers.every(Number.isFinite) ? numbers : null;
}

// The state of the page that is shown.
export const address = {
  get: (name) => stateOf(location.hash).get(name),
  numbers: (name, n) => numbersOf(address.get(name), n),
  // One of the values, or the first of them.
  word: (name, values) => (values.includes(address.get(name)) ? address.get(name) : values[0]),
  // Steps that Back undoes.
  go(changes) { address.write(changes, 'pushState'); },
  // What moves all the time, such as a slider.
  keep(changes) { address.write(changes, 'replaceState'); },
  write(changes, how) {
    const next = changed(location.hash, changes);
    if (next !== (location.hash || '#')) history[how](null, '', next);
  },
};
