// Names of the cells of a group. A technique's settings that differ are named in all its cells, those with a default too.

const words = (label) => (label ?? '').split(' ').filter(Boolean);
const keyOf = (word) => word.split('=', 1)[0];
const writtenAs = (value) => (typeof value === 'string' ? value : JSON.stringify(value));

// The names of the parameters that are not the same in all these cells.
function differing(cells) {
  const names = new Set(cells.flatMap((cell) => Object.keys(cell.parameters ?? {})));
  return [...names].filter((name) => new Set(cells.map((cell) => JSON.stringify(cell.parameters?.[name]))).size > 1);
}

// Adds to each cell its `title`, with all settings that differ from the defaults or among the cells of its technique, and
// `short`, for labels in plots: if there are several such cells, only with what differs among them.
export function named(cells) {
  const families = new Map();
  for (const cell of cells) families.set(cell.technique, [...families.get(cell.technique) ?? [], cell]);
  const differences = new Map([...families].map(([technique, own]) => [technique, differing(own)]));
  return cells.map((cell) => {
    const own = words(cell.label), keys = new Set(own.map(keyOf));
    const differs = differences.get(cell.technique);
    const more = differs.filter((name) => !keys.has(name) && name in (cell.parameters ?? {})).map((name) => `${name}=${writtenAs(cell.parameters[name])}`);
    const all = [...own, ...more];
    const short = families.get(cell.technique).length > 1 ? all.filter((word) => differs.includes(keyOf(word))) : all;
    return {...cell, title: [cell.technique, ...all].join(' '), short: [cell.technique, ...short].join(' ')};
  });
}
