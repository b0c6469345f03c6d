// What a form can show of a scenario, and the scenario with one of these choices changed. The scenario stays as it is
// where it holds what no form shows.

const radians = Math.PI / 180;
const round = (value) => Number(value.toPrecision(5));
const isPoint = (value) => Array.isArray(value) && value.length === 3 && value.every(Number.isFinite);

// From what the first light shines on to the light; nothing for lights without a direction of their own.
function towards(light) {
  if (isPoint(light?.direction)) return light.direction.map((v) => -v);
  return isPoint(light?.position) && isPoint(light.target) ? light.position.map((v, i) => v - light.target[i]) : null;
}

// Where [across, up, deep] of a direction stand in it: y is up, or z if the camera says so.
function axesOf(scenario) {
  const up = scenario.receivers?.up;
  return isPoint(up) && Math.abs(up[2]) > Math.abs(up[1]) ? [1, 2, 0] : [0, 1, 2];
}

// Where the first light stands as seen from what it shines on, in degrees: {around, height}.
export function lightPlace(scenario) {
  const arrow = towards(scenario?.lights?.[0]);
  const length = arrow && Math.hypot(...arrow);
  if (!length) return null;
  const [x, y, z] = axesOf(scenario).map((axis) => arrow[axis]);
  return {around: Math.round((Math.atan2(z, x) / radians + 360) % 360), height: Math.round(Math.asin(y / length) / radians)};
}

// The light keeps its distance.
export function withLight(scenario, {around, height}) {
  const [light, ...others] = scenario.lights, length = Math.hypot(...towards(light));
  const flat = length * Math.cos(height * radians), arrow = [];
  const parts = [flat * Math.cos(around * radians), length * Math.sin(height * radians), flat * Math.sin(around * radians)];
  axesOf(scenario).forEach((axis, i) => { arrow[axis] = parts[i]; });
  const moved = isPoint(light.direction) ? {...light, direction: arrow.map((v) => round(-v))}
    : {...light, position: arrow.map((v, i) => round(light.target[i] + v))};
  const sweeps = Object.fromEntries(Object.entries(scenario.sweeps ?? {}).filter(([pointer]) => !/^\/lights\/0\/(direction|position|target)(\/|$)/.test(pointer)));
  return {...scenario, lights: [moved, ...others], ...(scenario.sweeps && {sweeps})};  // such a sweep would set it again
}

export function withRays(scenario, name, value) {
  const sweeps = {...scenario.sweeps};
  delete sweeps[`/rays/${name}`];  // a sweep would set it again
  return {...scenario, rays: {...scenario.rays, [name]: value}, ...(scenario.sweeps && {sweeps})};
}

// The types of techniques; `all`: what "*" stands for.
export function typesOf(scenario, all) {
  const types = new Set((Array.isArray(scenario?.techniques) ? scenario.techniques : []).map((t) => t?.type));
  return types.delete('*') ? new Set([...types, ...all]) : types;
}

// The scenario with these types: settings of those that stay are kept, new ones have their defaults. Sweeps follow their
// techniques, or go with them.
export function withTypes(scenario, types, all) {
  const had = typesOf(scenario, all), kept = [], numbers = new Map();
  scenario.techniques.forEach((technique, i) => {
    if (!types.has(technique.type)) return;
    numbers.set(String(i), kept.length);
    kept.push(technique);
  });
  const stars = scenario.techniques.some((t) => t.type === '*') ? had : new Set();
  const present = new Set(kept.map((t) => t.type));
  const added = [...types].filter((type) => !present.has(type) && (!had.has(type) || stars.has(type)));
  const sweeps = Object.entries(scenario.sweeps ?? {}).flatMap(([pointer, values]) => {
    const [, index, rest] = /^\/techniques\/(\d+)(\/.*)$/.exec(pointer) ?? [];
    if (index === undefined) return [[pointer, values]];
    return numbers.has(index) ? [[`/techniques/${numbers.get(index)}${rest}`, values]] : [];
  });
  return {...scenario, techniques: [...kept, ...added.map((type) => ({type}))], ...(scenario.sweeps && {sweeps: Object.fromEntries(sweeps)})};
}

const isObject = (value) => value !== null && typeof value === 'object' && !Array.isArray(value);
const merged = (value, part) => (isObject(value) && isObject(part)
  ? Object.entries(part).reduce((all, [key, own]) => ({...all, [key]: merged(all[key], own)}), value) : part);

const leavesOf = (part, at = '') => (isObject(part) ? Object.entries(part).flatMap(([key, own]) => leavesOf(own, `${at}/${key}`)) : [at]);
const within = (pointer, of) => pointer === of || pointer.startsWith(`${of}/`);

// The scenario with a part merged into it key by key. Sweeps that would set what the part sets are left out.
export function withPart(scenario, part) {
  const all = merged(scenario, part), set = leavesOf(part);
  if (!scenario.sweeps) return all;
  return {...all, sweeps: Object.fromEntries(Object.entries(scenario.sweeps).filter(([pointer]) => !set.some((leaf) => within(pointer, leaf) || within(leaf, pointer))))};
}

// Whether a form may write the text again: numbers of more digits than JavaScript keeps would change.
export function keepsDigits(text) {
  return !/\d{16,}/.test(text.replace(/"(?:[^"\\]|\\.)*"/g, ''));
}
