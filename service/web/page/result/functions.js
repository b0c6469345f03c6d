// Visibility functions as the page draws them: vertices from left to right, two at one depth being a step.

// The vertices of one function over the whole depth range: its first value before, its last value after.
export function verticesOf(curve, {z, v}, low, high, look) {
  const first = v.length ? v[0] : 1, last = v.length ? v.at(-1) : 1;
  return [[low, first], ...z.map((depth, i) => [depth, v[i]]), [high, last]]
    .map(([depth, value], order) => ({curve, order, z: depth, v: value, ...look}));
}

// One channel of a function. In a coloured map each channel may have its own depths.
export function channelOf(curve, channel) {
  return {z: curve.channels_z?.[channel] ?? curve.z, v: curve.channels?.[channel] ?? curve.v};
}

// The values just before and just after a depth.
export function around({z, v}, depth) {
  if (!z.length) return [1, 1];
  const from = z.findIndex((d) => d >= depth);
  if (from < 0) return [v.at(-1), v.at(-1)];
  if (z[from] > depth) {
    if (from === 0) return [v[0], v[0]];
    const t = (depth - z[from - 1]) / (z[from] - z[from - 1]), value = v[from - 1] + t * (v[from] - v[from - 1]);
    return [value, value];
  }
  let to = from;
  while (to + 1 < z.length && z[to + 1] === depth) ++to;
  return [v[from], v[to]];
}

// a − b as vertices [depth, difference]: straight between the depths of both, and with the steps of both.
export function differenceOf(a, b, low, high) {
  const depths = [...new Set([low, ...a.z, ...b.z, high])].sort((p, q) => p - q);
  return depths.flatMap((depth) => {
    const [before, after] = [0, 1].map((side) => around(a, depth)[side] - around(b, depth)[side]);
    return before === after ? [[depth, before]] : [[depth, before], [depth, after]];
  });
}
