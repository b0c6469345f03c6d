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

// Gives the values just before and just after depths, which may not decrease from call to call.
function walker({z, v}) {
  let from = 0;
  return (depth) => {
    if (!z.length) return [1, 1];
    while (from < z.length && z[from] < depth) ++from;
    if (from === z.length) return [v.at(-1), v.at(-1)];
    if (z[from] > depth) {
      if (from === 0) return [v[0], v[0]];
      const t = (depth - z[from - 1]) / (z[from] - z[from - 1]), value = v[from - 1] + t * (v[from] - v[from - 1]);
      return [value, value];
    }
    let to = from;
    while (to + 1 < z.length && z[to + 1] === depth) ++to;
    return [v[from], v[to]];
  };
}

// The values just before and just after a depth.
export function around(curve, depth) {
  return walker(curve)(depth);
}

// a − b as vertices [depth, difference]: straight between the depths of both, and with the steps of both.
export function differenceOf(a, b, low, high) {
  const depths = [...new Set([low, ...a.z, ...b.z, high])].sort((p, q) => p - q), ofA = walker(a), ofB = walker(b);
  return depths.flatMap((depth) => {
    const first = ofA(depth), second = ofB(depth);
    const [before, after] = [0, 1].map((side) => first[side] - second[side]);
    return before === after ? [[depth, before]] : [[depth, before], [depth, after]];
  });
}

// Fewer vertices {z, v} of one function, whose lines differ from those of all by at most the tolerance. Steps stay. A plot
// cannot show differences below a pixel, and takes as long as it has vertices.
export function thinned(vertices, tolerance) {
  const kept = vertices.slice(0, 1);
  let low = -Infinity, high = Infinity, last = null;
  const keep = (vertex) => { kept.push(vertex); low = -Infinity; high = Infinity; last = null; };
  for (const vertex of vertices.slice(1)) {
    const from = kept.at(-1), slope = (vertex.v - from.v) / (vertex.z - from.z);
    if (last && !(slope >= low && slope <= high)) keep(last);
    const {z, v} = kept.at(-1), run = vertex.z - z;
    if (run <= 0) { keep(vertex); continue; }
    low = Math.max(low, (vertex.v - tolerance - v) / run);
    high = Math.min(high, (vertex.v + tolerance - v) / run);
    last = vertex;
  }
  return last ? [...kept, last] : kept;
}
