// Finds the values of a JSON text by their JSON pointers (RFC 6901).

// Thrown for text that is not JSON; `offset` is the place of the fault.
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
    if (depth > deepest) this.fail('Expected fewer levels of brackets');
    if (this.take('{')) this.members(pointer, depth);
    else if (this.take('[')) this.elements(pointer, depth);
    else if (this.match(string) === null && this.match(number) === null && this.match(word) === null)
      this.fail('Expected a value');
  }

  members(pointer, depth) {
    if (this.take('}')) return;
    do {
      this.match(space);
      const start = this.at;
      const name = this.match(string);
      if (name === null) this.fail('Expected a name in double quotes');
      if (!this.take(':')) this.fail('Expected ":"');
      this.value(`${pointer}/${JSON.parse(name).replaceAll('~', '~0').replaceAll('/', '~1')}`, start, depth + 1);
    } while (this.take(','));
    if (!this.take('}')) this.fail('Expected "," or "}"');
  }

  elements(pointer, depth) {
    if (this.take(']')) return;
    let index = 0;
    do this.value(`${pointer}/${index++}`, null, depth + 1);
    while (this.take(','));
    if (!this.take(']')) this.fail('Expected "," or "]"');
  }
}

// Returns a map of pointer -> offset. The offset of a member of an object is that of its name. Throws JsonFault.
export function places(text) {
  const scanner = new Scanner(text);
  scanner.value('', null, 0);
  scanner.match(space);
  if (scanner.at < text.length) scanner.fail('Expected the end');
  return scanner.places;
}

// The offset of the pointer, or of the innermost value around it that exists.
export function offsetOf(map, pointer) {
  for (let p = pointer; ; p = p.slice(0, p.lastIndexOf('/'))) {
    if (map.has(p)) return map.get(p);
    if (!p.includes('/')) return 0;
  }
}

// The line of an offset, from 0.
export function lineOf(text, offset) {
  let line = 0;
  for (let i = text.indexOf('\n'); i !== -1 && i < offset; i = text.indexOf('\n', i + 1)) ++line;
  return line;
}
