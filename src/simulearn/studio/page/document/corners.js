// The corners of joints, as grid/corners.py numbers them, so that goals stay at theirs.
//
// A joint has four corners, in the gaps between its beams; the widest gaps are divided until there
// are four. They are numbered counter-clockwise from +x, so a turn or another beam renumbers them.

import { lasting } from "./structure.js";

const TIE = 1e-9; // radians; angles closer than this are equal
const TURN = 2 * Math.PI;

/** Return a function (k, n, corner) -> corner: where a corner of joint k before is of joint n after.
 *
 * turn(angle): the direction after of one before, radians. mirrored: whether left is right after.
 */
export function cornerFollower(before, after, turn = (angle) => angle, mirrored = false) {
  const [old, next] = [anglesIn(before), anglesIn(after)];
  return (k, n, corner) => {
    if (corner === "centre") return corner;
    const [from, to] = [old(k)?.map(turn), next(n)];
    if (!from || !to) return corner;
    const inOrder = mirrored ? from.reverse() : from;
    const place = mirrored ? 3 - (corner % 4) : corner % 4;
    const shift = [0, 1, 2, 3].reduce((best, s) => (off(inOrder, to, s) < off(inOrder, to, best) ? s : best));
    return ((place + shift) % 4) + 4 * Math.floor(corner / 4);
  };
}

/** Return the directions of the four corners of joint k, radians; null where it has none. */
export function cornerAngles(grid, k) {
  return anglesIn(grid)(k);
}

/** Return how far directions are from others that are numbered on by a shift. */
function off(from, to, shift) {
  return from.reduce((sum, angle, k) => {
    const apart = modulo(angle - to[(k + shift) % 4]);
    return sum + Math.min(apart, TURN - apart);
  }, 0);
}

function anglesIn(grid) {
  let stay = null;
  return (k) => {
    stay ??= lasting(grid).beams;
    const halves = halvesAt(grid, k, stay);
    return halves.length >= 1 && halves.length <= 4 ? angles(halves, grid.beams.length) : null;
  };
}

/** Return {beam, angle} of the beams that leave joint k, by rising angle; first those that start there. */
function halvesAt({ joints, beams }, k, stay) {
  const halves = [0, 1].flatMap((end) =>
    beams.flatMap((ends, beam) => {
      if (ends[end] !== k || (stay.size && !stay.has(beam))) return [];
      const [dx, dy] = [0, 1].map((axis) => joints[ends[1 - end]][axis] - joints[k][axis]);
      return [{ beam, angle: Math.atan2(dy, dx) }];
    }));
  return halves.sort((a, b) => a.angle - b.angle);
}

function angles(halves, count) {
  const gaps = halves.map(({ beam, angle }, k) => {
    const last = k === halves.length - 1;
    const next = halves[last ? 0 : k + 1];
    const between = Math.min(beam, next.beam) * count + Math.max(beam, next.beam);
    return { angle, width: next.angle - angle + (last ? TURN : 0), between, parts: 1 };
  });
  for (let total = gaps.length; total < 4; total += 1) {
    const widest = Math.max(...gaps.map(({ width, parts }) => width / parts));
    gaps
      .filter(({ width, parts }) => width / parts >= widest - TIE)
      .reduce((a, b) => (rank(b, count) < rank(a, count) ? b : a)).parts += 1;
  }
  const all = gaps.flatMap(({ angle, width, parts }) =>
    Array.from({ length: parts }, (_, part) => modulo(angle + (width / parts) * (part + 0.5) + TIE) - TIE));
  return all.sort((a, b) => a - b);
}

function rank({ parts, between }, count) {
  return parts * count * count + between;
}

function modulo(angle) {
  return ((angle % TURN) + TURN) % TURN;
}
