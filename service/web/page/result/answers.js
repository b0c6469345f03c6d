// Which cell to take at an error that is allowed.
import {size, withoutMap} from './model.js';

const highest = (m) => Math.max(m.value, m.high ?? m.value);

// Of `cells`, the one with the least of a measure; nothing if none has it.
function least(cells, measure) {
  return cells.reduce((best, cell) => {
    const value = measure.of(cell)?.value;
    return value !== undefined && (!best || value < measure.of(best).value) ? cell : best;
  }, null);
}

// Another cell that may be as good: their intervals meet, and it is not surely worse.
function rivals(cells, best, measure) {
  const bar = measure.of(best);
  return cells.filter((cell) => {
    const m = measure.of(cell);
    return cell !== best && m && m.low !== undefined && m.low !== null && m.low <= (bar.high ?? bar.value);
  });
}

const soundOf = (cells, error) => cells.filter((cell) => cell.status === 'ok' && cell.verdict !== 'failed' && error.of(cell));

// {fastest, smallest, rivals, traced, closest, certain}: cells, or nothing: `fastest` too, where no time was measured. Counted are those that work, have a map, and
// whose error is at most `budget`, with its interval; without such, those whose value is (`certain` is false then).
// `traced`: the fastest without a map. `closest`: the least error of a map, if none reaches the budget.
export function answersAt(cells, {error, speed, budget}) {
  const sound = soundOf(cells, error);
  const maps = sound.filter((cell) => !withoutMap(cell));
  const surely = (cell) => highest(error.of(cell)) <= budget, measured = (cell) => error.of(cell).value <= budget;
  const certain = maps.some(surely), fitting = maps.filter(certain ? surely : measured);
  const fastest = least(fitting, speed);
  return {
    certain, fitting: fitting.length, fastest, smallest: least(fitting, size),
    rivals: fastest ? rivals(fitting, fastest, speed) : [],
    traced: least(sound.filter((cell) => withoutMap(cell) && measured(cell)), speed),
    closest: fitting.length ? null : least(maps, error),
  };
}

// A round error that some map of these cells reaches, to start with.
export function firstBudget(cells, error) {
  const values = soundOf(cells, error).filter((cell) => !withoutMap(cell)).map((cell) => highest(error.of(cell))).filter((v) => v > 0);
  if (!values.length) return 0.05;
  const wanted = 1.1 * Math.min(...values), power = 10 ** Math.floor(Math.log10(wanted));
  return Number(([1, 1.5, 2, 3, 4, 5, 7, 10].find((m) => m * power >= wanted) * power).toPrecision(2));
}
