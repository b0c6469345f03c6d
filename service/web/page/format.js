// Formats numbers and times.

const none = '–';

// value.toPrecision(digits), except that a value in the middle goes to the even digit, as in the texts of the program:
// 0.125 is 0.12.
function precise(value, digits) {
  const rounded = value.toPrecision(digits), exact = value.toPrecision(60);
  const places = (text) => text.replace(/e.*$/, '').replace(/[-.]/g, '').replace(/^0+/, '');
  const kept = places(exact).slice(0, digits);
  if (!/^50*$/.test(places(exact).slice(digits)) || Number(kept.at(-1)) % 2) return Number(rounded);
  const exponent = Math.floor(Math.log10(Math.abs(value))) - digits + 1;
  return Number(`${value < 0 ? '-' : ''}${kept}e${exponent}`);
}

// The nearest whole number, by the same rule: 1000.5 is 1000.
function whole(value) {
  return Math.abs(value % 1) === 0.5 ? 2 * Math.round(value / 2) : Math.round(value);
}

// A number with significant digits and thin separators; without an exponent where it is readable.
export function significant(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return none;
  if (value === 0) return '0';
  const size = Math.abs(value);
  // An exponent has two digits, as in the texts of the program.
  if (size < 1e-4 || size >= 1e7) return precise(value, digits).toExponential().replace('e+', 'e').replace(/e(-?)(\d)$/, 'e$10$2');
  if (size >= 10 ** digits) return whole(value).toLocaleString('en-GB');
  return String(precise(value, digits));
}

export function count(value) {
  return Number.isFinite(value) ? value.toLocaleString('en-GB') : none;
}

export function bytes(value, digits = 3) {
  if (!Number.isFinite(value)) return none;
  const units = ['B', 'KiB', 'MiB', 'GiB', 'TiB'];
  let unit = 0;
  for (; value >= 1024 && unit + 1 < units.length; ++unit) value /= 1024;
  return `${value >= 10 ** digits ? whole(value) : significant(value, digits)} ${units[unit]}`;
}

export function nanoseconds(value) {
  if (!Number.isFinite(value)) return none;
  if (value >= 1e9) return `${significant(value / 1e9)} s`;
  if (value >= 1e6) return `${significant(value / 1e6)} ms`;
  return value >= 1e3 ? `${significant(value / 1e3)} µs` : `${significant(value)} ns`;
}

export function seconds(value) {
  if (!Number.isFinite(value)) return none;
  if (value < 60) return `${significant(value, value < 1 ? 2 : 3)} s`;
  const all = Math.round(value);
  return all < 3600 ? `${Math.floor(all / 60)} min ${all % 60} s`
    : `${Math.floor(all / 3600)} h ${Math.floor((all % 3600) / 60)} min`;
}

export function percent(fraction) {
  return `${Math.round(100 * fraction)} %`;
}

// An ISO time in the reader's zone.
export function moment(iso) {
  const date = new Date(iso);
  return Number.isNaN(date.getTime()) ? none
    : date.toLocaleString('en-GB', {dateStyle: 'medium', timeStyle: 'medium'});
}

const lineLength = 100;

const nested = (value) => value !== null && typeof value === 'object' && Object.keys(value).length > 0;

// JSON as people write it: a value that fits a line and has at most one more level of brackets is on one line.
export function written(value) {
  return `${lines(value, '')}\n`;
}

function lines(value, indent) {
  if (!nested(value)) return JSON.stringify(value);
  const inner = `${indent}  `, list = Array.isArray(value);
  const parts = (write) => (list ? value.map(write) : Object.entries(value).map(([k, v]) => `${JSON.stringify(k)}: ${write(v)}`));
  const [open, close] = list ? '[]' : '{}';
  if (!Object.values(value).some((v) => nested(v) && Object.values(v).some(nested))) {
    const line = open + parts((v) => lines(v, '')).join(', ') + close;
    if (line.length + indent.length <= lineLength && !line.includes('\n')) return line;
  }
  return `${open}\n${parts((v) => lines(v, inner)).map((part) => inner + part).join(',\n')}\n${indent}${close}`;
}

// Rows of cells as CSV (RFC 4180). Nothing becomes an empty field.
export function csvOf(rows) {
  const field = (value) => {
    const text = value === null || value === undefined ? '' : String(value);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return rows.map((row) => `${row.map(field).join(',')}\r\n`).join('');
}

export function plural(n, one, many = `${one}s`) {
  return `${count(n)} ${n === 1 ? one : many}`;
}

// A key by which the server knows a request that is sent twice.
export function newKey() {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (b) => b.toString(16).padStart(2, '0')).join('');
}
