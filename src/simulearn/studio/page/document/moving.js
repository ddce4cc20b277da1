// Changes of where joints are: moves, turns, mirror images, sizes.

import { FARTHEST, between, distance, isNumber, isPoint, rounded } from "./geometry.js";

/** Return the joints of a selection: those selected and the ends of selected beams.
 *
 * selection: {joints, beams}; null, "all" and one without parts stand for all joints.
 */
export function jointsOf(grid, selection) {
  const { joints = [], beams = [] } = selection === "all" || !selection ? {} : selection;
  const all = new Set(joints.filter((k) => k in grid.joints));
  for (const b of beams) for (const k of grid.beams[b] ?? []) all.add(k);
  return all.size ? [...all].sort((a, b) => a - b) : grid.joints.map((_, k) => k);
}

/** Move joints by [dx, dy] mm. */
export function moveJoints(document, numbers, [dx, dy]) {
  return place(document, numbers, ([x, y]) => [x + dx, y + dy]);
}

/** Put joint k at [x, y]. */
export function placeJoint(document, k, point) {
  return place(document, [k], () => point);
}

/** Mirror a selection or all: "x" exchanges left and right, "y" up and down.
 *
 * A selection is mirrored about its middle, the whole about the fixed joint. What is active on the
 * top half stays so. Targets and sides of goals are mirrored with the whole.
 */
export function mirror(document, selection, axis) {
  const numbers = jointsOf(document.grid, selection);
  const [u, v] = pivot(document.grid, numbers);
  const flip = axis === "x" ? ([x, y]) => [2 * u - x, y] : ([x, y]) => [x, 2 * v - y];
  const next = place(document, numbers, flip);
  if (next === document || numbers.length < next.grid.joints.length) return next;
  const target = axis === "x" ? ([x, y, z]) => [-x + 0, y, z] : ([x, y, z]) => [x, -y + 0, z];
  const goals = next.goals.map((goal) => ({
    ...goal, target: target(goal.target), vertex: mirrored(goal.vertex, axis),
  }));
  return { ...next, goals };
}

/** Turn a selection or all by degrees, counter-clockwise.
 *
 * about: the point that stays; unless given, the fixed joint where it is among the joints, else the
 * selection's middle. Targets are turned with the whole.
 */
export function rotate(document, selection, degrees, about = null) {
  const { grid } = document;
  const numbers = jointsOf(grid, selection);
  if (!isNumber(degrees) || (about !== null && !isPoint(about))) return document;
  const middle = numbers.includes(grid.fixed) ? grid.joints[grid.fixed] : pivot(grid, numbers);
  const [u, v] = about ?? middle;
  const [c, s] = turn(degrees);
  const next = place(document, numbers, ([x, y]) =>
    [u + c * (x - u) - s * (y - v), v + s * (x - u) + c * (y - v)]);
  if (next === document || numbers.length < grid.joints.length) return next;
  return withTargets(next, ([x, y, z]) => [rounded(c * x - s * y), rounded(s * x + c * y), z]);
}

/** Scale the grid about its fixed joint, and the targets with it. */
export function scale(document, factor) {
  const { grid } = document;
  if (!isNumber(factor) || factor <= 0 || grid.joints.length === 0) return document;
  const about = grid.joints[grid.fixed];
  const all = grid.joints.map((_, k) => k);
  const next = place(document, all, (point) => between(about, point, factor));
  if (next === document) return document;
  return withTargets(next, (target) => target.map((x) => rounded(factor * x)));
}

/** Give beam b a length, mm, by moving one end along it.
 *
 * The end with fewer beams moves, of two alike the one farther from the fixed joint, which stays.
 */
export function setBeamLength(document, b, length) {
  const { joints, beams, fixed } = document.grid;
  if (!(b in beams) || !isNumber(length) || length <= 0 || length > FARTHEST) return document;
  const [i, j] = beams[b];
  const valence = (k) => beams.filter((ends) => ends.includes(k)).length;
  const away = (k) => distance(joints[k], joints[fixed]);
  let moves = valence(i) === valence(j) ? (away(i) > away(j) ? i : j) : (valence(i) < valence(j) ? i : j);
  if (moves === fixed) moves = i === fixed ? j : i;
  const stays = moves === i ? j : i;
  const [p, q] = [joints[stays], joints[moves]];
  const now = distance(p, q);
  if (Math.abs(now - length) < 1e-9) return document;
  return placeJoint(document, moves, now > 0 ? between(p, q, length / now) : [p[0] + length, p[1]]);
}

/** Return the document with joints at map(place); itself where nothing moves or a place is none. */
function place(document, numbers, map) {
  const { grid } = document;
  const joints = [...grid.joints];
  let changed = false;
  for (const k of new Set(numbers)) {
    if (!(k in joints)) continue;
    const point = map(joints[k]);
    if (!isPoint(point)) return document;
    const next = point.map(rounded);
    if (distance(next, joints[k]) < 1e-7) continue;
    joints[k] = next;
    changed = true;
  }
  return changed ? { ...document, grid: { ...grid, joints } } : document;
}

/** Return what a mirror image keeps: the fixed joint for the whole, else the middle. */
function pivot(grid, numbers) {
  if (numbers.length === 0) return [0, 0];
  if (numbers.length === grid.joints.length) return grid.joints[grid.fixed];
  const [xs, ys] = [0, 1].map((axis) => numbers.map((k) => grid.joints[k][axis]));
  return [xs, ys].map((values) => (Math.min(...values) + Math.max(...values)) / 2);
}

/** Return cosine and sine, exact for right angles. */
function turn(degrees) {
  const quarters = degrees / 90;
  if (Number.isInteger(quarters)) {
    const sign = [[1, 0], [0, 1], [-1, 0], [0, -1]];
    return sign[((quarters % 4) + 4) % 4];
  }
  const radians = (degrees * Math.PI) / 180;
  return [Math.cos(radians), Math.sin(radians)];
}

function withTargets(document, map) {
  if (document.goals.length === 0) return document;
  return { ...document, goals: document.goals.map((goal) => ({ ...goal, target: map(goal.target) })) };
}

/** Return a vertex of the mirrored grid: right and left are exchanged. */
function mirrored(vertex, axis) {
  const corner = vertex.at(-1);
  if (corner === "centre") return vertex;
  // A beam's corners are right and left in turn. A joint's are counter-clockwise, two above it.
  const other = vertex[0] === "beam" || axis === "x" ? corner ^ 1 : corner ^ 3;
  return [...vertex.slice(0, -1), other];
}
