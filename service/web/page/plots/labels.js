// Places the labels of points so that they cover neither marks nor each other, as far as there is room.

const line = 14;  // pixels of a label's text
const guess = (text) => 8 * text.length;
const touch = 0.5;  // square pixels that are no overlap
const close = 7;  // pixels: a label further from its mark, or this near another one, has a line to its own
const reaches = [0, 6, 13, 22, 34, 48];
const directions = [[1, -1], [1, 0], [1, 1], [0, -1], [-1, -1], [-1, 0], [-1, 1], [0, 1]];

const boxOf = (x, y, halfWidth, halfHeight) => ({left: x - halfWidth, right: x + halfWidth, top: y - halfHeight, bottom: y + halfHeight});

function overlap(a, b) {
  const across = Math.min(a.right, b.right) - Math.max(a.left, b.left), down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
  return across > 0 && down > 0 ? across * down : 0;
}

// From the edge of a mark to the nearest edge of its label's box, as offsets from the mark.
function leadTo({x, y, radius}, {box}) {
  const to = [Math.max(box.left, Math.min(box.right, x)) - x, Math.max(box.top + 3, Math.min(box.bottom - 3, y)) - y], length = Math.hypot(...to);
  return length > radius + 2 ? {from: to.map((v) => v * radius / length), to} : null;
}

// points: {x, y, texts, radius, first}, in pixels; lines: [x0, y0, x1, y1], horizontal or vertical. Each point gets the
// first of its texts that has a free place, or the last one; those that are `first` choose before the others. Returns for
// each point {text, dx, dy, lead}, with the offset of the middle of the text; `lead`: {from, to}, offsets of
// the ends of a line to a label that could belong to another mark, or nothing. Avoiding marks and labels comes before lines, and these before
// places that are near other marks.
// widthOf(text): in pixels. furthest: how far a label may stand from its mark, in pixels.
export function placeLabels({points, lines, width, height, widthOf = guess, furthest = Infinity}) {
  const marks = points.map((p) => boxOf(p.x, p.y, p.radius, p.radius));
  const surroundings = points.map((p) => boxOf(p.x, p.y, p.radius + close, p.radius + close));
  const strokes = lines.map(([x0, y0, x1, y1]) => ({left: Math.min(x0, x1) - 1, right: Math.max(x0, x1) + 1, top: Math.min(y0, y1) - 1, bottom: Math.max(y0, y1) + 1}));
  const taken = [], placed = [];
  const place = (p, text) => {
    const halfWidth = widthOf(text) / 2 + 2, halfHeight = line / 2;
    let best = null;
    for (const reach of reaches.filter((r) => r <= furthest))
      for (const [right, down] of directions) {
        const dx = right * (p.radius + halfWidth + reach), dy = down * (p.radius + (right ? 0 : halfHeight) + reach);
        const box = boxOf(p.x + dx, p.y + dy, halfWidth, halfHeight);
        const outside = box.left < 0 || box.right > width || box.top < 0 || box.bottom > height;
        const hidden = [...marks, ...taken].reduce((sum, other) => sum + overlap(box, other), 0);
        const crossed = strokes.reduce((sum, other) => sum + overlap(box, other), 0);
        const besides = points.some((other, i) => other !== p && overlap(box, surroundings[i]) > touch);
        const cost = 1000 * outside + 50 * hidden + 2 * crossed + 15 * besides + reach;
        if (!best || cost < best.cost) best = {cost, text, dx, dy, box, free: !outside && hidden < touch, leads: besides || reach > close};
      }
    return best;
  };
  const order = points.map((_, i) => i).sort((a, b) => Boolean(points[b].first) - Boolean(points[a].first) || a - b);
  for (const i of order) {
    let best = null;
    for (const text of points[i].texts) {
      best = place(points[i], text);
      if (best.free) break;
    }
    taken.push(best.box);
    placed[i] = {text: best.text, dx: best.dx, dy: best.dy, lead: best.text && best.leads ? leadTo(points[i], best) : null};
  }
  return placed;
}

// What specs.js draws for a label that was placed.
export function labelFields({text, dx, dy, lead}) {
  const [[fromX, fromY], [toX, toY]] = lead ? [lead.from, lead.to] : [[0, 0], [0, 0]];
  return {label: text, dx, dy, fromX, fromY, toX, toY};
}
