// Where the values of a JSON text stand, by their JSON pointers (RFC 6901).

// Thrown for text that is no JSON; `offset` is where.
export class JsonFault extends Error {
  constructor(message, offset) {
    super(message);
    this.offset = offset;
  }
}

const number = /-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][+-]?\d+)?/y;
const string = /"(?:[^"\\\u0000-\u001f]|\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4}))*"/y;
const word = /true|false|null/y;
const space = /[ \t\r\n]*/y;
const deepest = 500;

class Scanner {
  constructor(text) {
    this.text = text;
    this.at = 0;
    this.places = new Map();
  }

  match(pattern) {
    pattern.lastIndex = this.at;
    const found = pattern.exec(this.text);
    if (!found) return null;
    this.at = pattern.lastIndex;
    return found[0];
  }

  fail(message) {
    const found = this.at < this.text.length ? ` instead of ${JSON.stringify(this.text[this.at])}` : ' before the end';
    throw new JsonFault(message + found, Math.min(this.at, Math.max(0, this.text.length - 1)));
  }

  take(character) {
    this.match(space);
    if (this.text[this.at] !== character) return false;
    ++this.at;
    return true;
  }

  value(pointer, start, depth) {
    this.match(space);
    this.places.set(pointer, start ?? this.at);
    if (depth > deepest) this.fail('Fewer levels of brackets are expected');
    if (this.take('{')) this.members(pointer, depth);
    else if (this.take('[')) this.elements(pointer, depth);
    else if (this.match(string) === null && this.match(number) === null && this.match(word) === null)
      this.fail('A value is expected');
  }

  members(pointer, depth) {
    if (this.take('}')) return;
    do {
      this.match(space);
      const start = this.at;
      const name = this.match(string);
      if (name === null) this.fail('A name in double quotes is expected');
      if (!this.take(':')) this.fail('":" is expected');
      this.value(`${pointer}/${JSON.parse(name).replaceAll('~', '~0').replaceAll('/', '~1')}`, start, depth + 1);
    } while (this.take(','));
    if (!this.take('}')) this.fail('"," or "}" is expected');
  }

  elements(pointer, depth) {
    if (this.take(']')) return;
    let index = 0;
    do this.value(`${pointer}/${index++}`, null, depth + 1);
    while (this.take(','));
    if (!this.take(']')) this.fail('"," or "]" is expected');
  }
}

// Map of pointer -> offset; a member of an object stands where its name begins. Throws JsonFault.
export function places(text) {
  const scanner = new Scanner(text);
  scanner.value('', null, 0);
  scanner.match(space);
  if (scanner.at < text.length) scanner.fail('The end is expected');
  return scanner.places;
}

// Offset of the pointer, or of the nearest value around it that is there.
export function offsetOf(map, pointer) {
  for (let p = pointer; ; p = p.slice(0, p.lastIndexOf('/'))) {
    if (map.has(p)) return map.get(p);
    if (!p.includes('/')) return 0;
  }
}

// Line of an offset, from 0 on.
export function lineOf(text, offset) {
  let line = 0;
  for (let i = text.indexOf('\n'); i !== -1 && i < offset; i = text.indexOf('\n', i + 1)) ++line;
  return line;
}
