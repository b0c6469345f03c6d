// Computes the domains and ticks of axes.
import {bytes, nanoseconds, significant} from '../format.js';

const writers = {
  ns: nanoseconds,
  ms: (v) => nanoseconds(1e6 * v),
  ratio: (v) => `${significant(v)} ×`,
  bytes,
  error: (v) => significant(v),
};

export function write(kind, value) {
  return value === 0 ? '0' : writers[kind](value);
}

function steps(low, high, base, multiples) {
  const result = [];
  for (let power = base ** Math.floor(Math.log(low) / Math.log(base)); power <= high; power *= base)
    for (const m of multiples) if (power * m >= low && power * m <= high) result.push(power * m);
  return result;
}

function logTicks(low, high, kind) {
  if (kind === 'bytes')
    for (const base of [2, 4, 16, 64, 1024]) {
      const ticks = steps(low, high, base, [1]);
      if (ticks.length <= 8) return ticks;
    }
  const candidates = [[1, 2, 3, 5, 7], [1, 2, 5], [1, 3], [1]].map((m) => steps(low, high, 10, m));
  const most = candidates.at(-1), each = Math.ceil(most.length / 9);
  return candidates.find((t) => t.length <= 9) ?? most.filter((_, i) => i % each === 0);
}

const least = 1e-250;  // well above the smallest double

// A log axis that covers all values. Zeros go to its lower end (`zero`), which is marked as 0.
export function logAxis(name, values, kind) {
  const positive = values.filter((v) => v > 0);
  let low = positive.length ? Math.min(...positive) : 0.1;
  let high = positive.length ? Math.max(...positive) : 1;
  const span = Math.log10(high) - Math.log10(low);
  const margin = Math.max(1.15, 10 ** (0.07 * span));
  low = Math.max(least, low / margin);
  high = Math.min(1 / least, high * margin);
  let ticks = logTicks(low, high, kind);
  for (; ticks.length < 2; ticks = logTicks(low, high, kind)) [low, high] = [Math.max(least, low / 1.4), Math.min(1 / least, 1.4 * high)];  // a single value
  const labels = ticks.map((t) => write(kind, t));
  let zero = null;
  if (values.some((v) => v === 0)) {
    zero = Math.max(least, low / Math.max(1.4, 10 ** (0.1 * span)));
    ticks.unshift(zero);
    labels.unshift('0');
    low = Math.max(least, zero / margin);
  }
  return {zero, signals: {[`${name}_low`]: low, [`${name}_high`]: high, [`${name}_ticks`]: ticks, [`${name}_labels`]: labels}};
}

// The position of a value on a log axis: 0 at its lower end, 1 at its upper end.
export function logPlace(name, signals, value) {
  const low = signals[`${name}_low`], high = signals[`${name}_high`];
  return Math.max(0, Math.min(1, Math.log(value / low) / Math.log(high / low)));
}

// A linear axis with about n ticks at round numbers.
export function linearAxis(name, low, high, n = 6, writeTick = (v) => significant(v, 4)) {
  if (!(high > low)) { high = low + 1e-9 + Math.abs(low) * 0.01; low -= 1e-9 + Math.abs(low) * 0.01; }
  const rough = (high - low) / n;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high * (1 + 1e-12) + step * 1e-9; ++i) ticks.push(Number((i * step).toPrecision(12)));
  return {[`${name}_low`]: low, [`${name}_high`]: high, [`${name}_ticks`]: ticks, [`${name}_labels`]: ticks.map(writeTick)};
}
