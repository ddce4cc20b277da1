// A toolpath as flat ribbons of the beads' widths: plain arrays, built once, ordered by layers so
// that a layer is a range of the triangles.

/** What has a colour of its own; "upper" are active beads of the upper half. */
export const TONES = ["skirt", "shell", "active", "passive", "joint", "upper", "brim"];

const SHARPEST = 2.5; // a corner's ribbon is at most this much wider than the bead

/** Return { positions, sides, tones, index, layerStart, travels } of a toolpath (`toolpath_to_dict`).
 *
 * sides: -1 at a bead's right edge, 1 at its left one; tones: numbers in `TONES`; layerStart[k]: first
 * index of layer k, with the end after the last one; travels: { drawn, kept }, those with filament drawn
 * back and the others, each { points: ends of the moves between beads, start: likewise by points }.
 */
export function ribbonsOf(toolpath) {
  const { starts, points, role, roles, layers } = toolpath;
  const layerOf = toolpath.layer_of;
  const active = roles.indexOf("active");
  const total = points.length;
  const positions = new Float32Array(6 * total);
  const sides = new Float32Array(2 * total);
  const tones = new Uint8Array(2 * total);
  const index = new Uint32Array(6 * Math.max(0, total - role.length));
  const layerStart = [];
  const travels = { drawn: { points: [], start: [] }, kept: { points: [], start: [] } };
  const beginLayer = () => {
    layerStart.push(at);
    for (const { points: ends, start } of Object.values(travels)) start.push(ends.length / 3);
  };
  let at = 0;
  for (let b = 0; b < role.length; b += 1) {
    while (layerStart.length <= layerOf[b]) beginLayer();
    const { z } = layers[layerOf[b]];
    const [first, end] = [starts[b], starts[b + 1]];
    if (b > 0 && layerOf[b - 1] === layerOf[b])
      travels[toolpath.drawn[b] ? "drawn" : "kept"].points.push(...points[first - 1], z, ...points[first], z);
    const upper = role[b] === active && layerOf[b] >= layers.length / 2;
    const tone = Math.max(0, TONES.indexOf(upper ? "upper" : roles[role[b]]));
    for (let k = first; k < end; k += 1) {
      const [nx, ny] = offset(points, first, end, k);
      const half = (toolpath.width[k < end - 1 ? k : k - 1] || 0) / 2;
      positions.set([points[k][0] - nx * half, points[k][1] - ny * half, z], 6 * k);
      positions.set([points[k][0] + nx * half, points[k][1] + ny * half, z], 6 * k + 3);
      sides[2 * k] = -1;
      sides[2 * k + 1] = 1;
      tones.fill(tone, 2 * k, 2 * k + 2);
      if (k < end - 1) {
        index.set([2 * k, 2 * k + 2, 2 * k + 1, 2 * k + 1, 2 * k + 2, 2 * k + 3], at);
        at += 6;
      }
    }
  }
  while (layerStart.length <= layers.length) beginLayer();
  return { positions, sides, tones, index, layerStart, travels };
}

/** Return the mitred normal of a path at point k, longer where it turns. */
function offset(points, first, end, k) {
  const closed = end - first > 2 && same(points[first], points[end - 1]);
  const before = k > first ? k - 1 : closed ? end - 2 : null;
  const after = k < end - 1 ? k + 1 : closed ? first + 1 : null;
  const a = before === null ? null : normal(points[before], points[k]);
  const b = after === null ? null : normal(points[k], points[after]);
  if (!a || !b) return a ?? b ?? [0, 0];
  const [x, y] = [a[0] + b[0], a[1] + b[1]];
  const square = x * x + y * y;
  if (square < 1e-6) return b; // the path turns back
  const scale = Math.min(2 / square, SHARPEST / Math.sqrt(square));
  return [x * scale, y * scale];
}

const same = (p, q) => Math.abs(p[0] - q[0]) < 1e-6 && Math.abs(p[1] - q[1]) < 1e-6;

function normal(p, q) {
  const [x, y] = [q[0] - p[0], q[1] - p[1]];
  const length = Math.hypot(x, y);
  return length < 1e-9 ? null : [-y / length, x / length];
}
