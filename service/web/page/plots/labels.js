// Places the labels of points so that they cover neither marks nor each other, as far as there is room.

const letter = 7, line = 13;  // pixels of a label's text
const reaches = [0, 6, 13, 22];
const directions = [[1, -1], [1, 0], [1, 1], [0, -1], [-1, -1], [-1, 0], [-1, 1], [0, 1]];

const boxOf = (x, y, halfWidth, halfHeight) => ({left: x - halfWidth, right: x + halfWidth, top: y - halfHeight, bottom: y + halfHeight});

function overlap(a, b) {
  const across = Math.min(a.right, b.right) - Math.max(a.left, b.left), down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
  return across > 0 && down > 0 ? across * down : 0;
}

// points: {x, y, text, radius}, in pixels; lines: [x0, y0, x1, y1], horizontal or vertical. Returns for each point {dx, dy},
// the offset of the middle of its text. Avoiding marks and other labels comes before avoiding lines.
export function placeLabels({points, lines, width, height}) {
  const marks = points.map((p) => boxOf(p.x, p.y, p.radius, p.radius));
  const strokes = lines.map(([x0, y0, x1, y1]) => ({left: Math.min(x0, x1) - 1, right: Math.max(x0, x1) + 1, top: Math.min(y0, y1) - 1, bottom: Math.max(y0, y1) + 1}));
  const taken = [];
  return points.map((p) => {
    const halfWidth = letter * p.text.length / 2, halfHeight = line / 2;
    let best = null;
    for (const reach of reaches)
      for (const [right, down] of directions) {
        const dx = right * (p.radius + halfWidth + reach), dy = down * (p.radius + (right ? 0 : halfHeight) + reach);
        const box = boxOf(p.x + dx, p.y + dy, halfWidth, halfHeight);
        const outside = box.left < 0 || box.right > width || box.top < 0 || box.bottom > height;
        const hidden = [...marks, ...taken].reduce((sum, other) => sum + overlap(box, other), 0);
        const crossed = strokes.reduce((sum, other) => sum + overlap(box, other), 0);
        const cost = 1000 * outside + 50 * hidden + crossed + reach;
        if (!best || cost < best.cost) best = {cost, dx, dy, box};
      }
    taken.push(best.box);
    return {dx: best.dx, dy: best.dy};
  });
}
