// Numbers of techniques, which select their colours and shapes in palette.js: the same in every result.

// New ones go to the end.
const known = ['shadow_map', 'pcf', 'deep', 'avsm', 'fourier', 'uncompressed', 'ray_traced', 'variance', 'opacity', 'multi_depth', 'volume_deep'];
const marks = 56;  // pairs of a colour and a shape

// A technique that is not known here gets a number by its name.
export function numberOf(technique) {
  const place = known.indexOf(technique), sum = [...technique].reduce((all, letter) => (31 * all + letter.codePointAt(0)) % 65521, 7);
  return place >= 0 ? place : known.length + sum % (marks - known.length);
}
