// Changes of where joints are: moves, turns, mirror images, sizes.

import { cornerFollower } from "./corners.js";
import { FARTHEST, between, distance, isNumber, isPoint, rounded } from "./geometry.js";
import { followedGoals, movedWishes } from "./kinds.js";
import { OTHER_SIDE } from "./numbering.js";

const SAME = 1e-7; // mm; places that are nearer are one

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

/** Mirror a selection or all joints: "x" exchanges left and right, "y" up and down.
 *
 * A selection is mirrored about its middle, all joints about the fixed one. What is active on the
 * top half stays so. Targets are mirrored with all joints.
 */
export function mirror(document, selection, axis) {
  const numbers = jointsOf(document.grid, selection);
  const [u, v] = pivot(document.grid, numbers);
  const x = axis === "x";
  const next = place(document, numbers, ([a, b]) => (x ? [2 * u - a, b] : [a, 2 * v - b]), {
    turn: (angle) => (x ? Math.PI - angle : -angle),
    mirrored: true,
  });
  return withTargets(next, document, numbers, ([a, b, c]) => (x ? [-a + 0, b, c] : [a, -b + 0, c]));
}

/** Turn a selection or all joints by degrees, counter-clockwise.
 *
 * about: the point that stays; unless given, the fixed joint where it is among them, else their
 * middle. Targets are turned with all joints.
 */
export function rotate(document, selection, degrees, about = null) {
  const { grid } = document;
  const numbers = jointsOf(grid, selection);
  if (!isNumber(degrees) || (about !== null && !isPoint(about))) return document;
  const middle = numbers.includes(grid.fixed) ? grid.joints[grid.fixed] : pivot(grid, numbers);
  const [u, v] = about ?? middle;
  const [c, s] = turn(degrees);
  const turned = ([x, y]) => [c * x - s * y, s * x + c * y];
  const next = place(document, numbers, (point) => {
    const [x, y] = turned([point[0] - u, point[1] - v]);
    return [u + x, v + y];
  }, { turn: (angle) => angle + Math.atan2(s, c) });
  return withTargets(next, document, numbers, ([x, y, z]) => [...turned([x, y]), z]);
}

/** Scale the grid about its fixed joint, and the targets with it. */
export function scale(document, factor) {
  const { grid } = document;
  if (!isNumber(factor) || factor <= 0 || grid.joints.length === 0) return document;
  const about = grid.joints[grid.fixed];
  const all = grid.joints.map((_, k) => k);
  const next = place(document, all, (point) => between(about, point, factor));
  return withTargets(next, document, all, (target) => target.map((x) => factor * x));
}

/** Give beam b a length, mm, by moving one end along it.
 *
 * The end with fewer beams moves, of two alike the one farther from the fixed joint, which stays.
 */
export function setBeamLength(document, b, length) {
  const { joints, beams } = document.grid;
  if (!(b in beams) || !isNumber(length) || length <= 0 || length > FARTHEST) return document;
  const [i, j] = beams[b];
  const moves = freer(document.grid, i, j);
  const stays = moves === i ? j : i;
  const [p, q] = [joints[stays], joints[moves]];
  const now = distance(p, q);
  if (Math.abs(now - length) < SAME) return document;
  return placeJoint(document, moves, now > 0 ? between(p, q, length / now) : [p[0] + length, p[1]]);
}

/** Return which of two joints may rather move. */
function freer({ joints, beams, fixed }, i, j) {
  if (i === fixed || j === fixed) return i === fixed ? j : i;
  const valence = (k) => beams.filter((ends) => ends.includes(k)).length;
  const more = valence(i) - valence(j);
  if (more !== 0) return more > 0 ? j : i;
  const away = (k) => distance(joints[k], joints[fixed]);
  return away(i) > away(j) ? i : j;
}

/** Return the document with joints at map(place); itself where nothing moves or a place is none.
 *
 * turn, mirrored: what becomes of directions at these joints, for goals at their corners.
 */
function place(document, numbers, map, { turn: direction = (angle) => angle, mirrored = false } = {}) {
  const { grid } = document;
  const joints = [...grid.joints];
  const moving = new Set(numbers);
  let changed = false;
  for (const k of moving) {
    if (!(k in joints)) continue;
    const point = map(joints[k]);
    if (!isPoint(point)) return document;
    const next = point.map(rounded);
    if (distance(next, joints[k]) < SAME) continue;
    joints[k] = next;
    changed = true;
  }
  if (!changed) return document;
  const next = { ...grid, joints };
  const turned = cornerFollower(grid, next, direction, mirrored);
  const others = cornerFollower(grid, next);
  const goals = followedGoals(document.goals, (vertex) => {
    const corner = vertex.at(-1);
    if (vertex[0] === "joint") {
      const [, k] = vertex;
      return ["joint", k, (moving.has(k) ? turned : others)(k, k, corner)];
    }
    const swap = mirrored && corner !== "centre" && grid.beams[vertex[1]].every((k) => moving.has(k));
    return swap ? [...vertex.slice(0, 3), OTHER_SIDE[corner]] : vertex;
  });
  return { ...document, grid: next, goals };
}

/** Return what a mirror image keeps: the fixed joint of all joints, else the middle. */
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

/** Return the document after a move with targets that have moved alike, if all joints have. */
function withTargets(next, document, numbers, map) {
  return next === document || numbers.length < next.grid.joints.length ? next : movedWishes(next, map);
}
