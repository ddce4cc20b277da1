// What refers to joints and beams by number follows them when the numbers change.

import { cornerFollower } from "./corners.js";
import { followedGoals, movedWishes } from "./kinds.js";
import { lasting } from "./structure.js";

const WHERE = { start: 0, middle: 0.5, end: 1 };
const OTHER_END = { start: "end", middle: "middle", end: "start" };
export const OTHER_SIDE = [1, 0, 3, 2]; // a section's right and left corners, seen from the other end

/** Return the document with other joints and beams; goals and the fixed joint follow.
 *
 * joints: places. jointOf(k): the new number of joint k, null where it is gone. pieces: the beams
 * {ends, ratio, beam, from, to}: new numbers of joints, and of which beam before it is the part
 * from..to in [0, 1] (beam null: it is new). Pieces without length and second ones are left out.
 */
export function rebuild(document, joints, pieces, jointOf) {
  const { grid } = document;
  const { beams, actuators, parts } = distinct(pieces, grid, joints.length);
  const fixed = fixedJoint(grid, joints, beams, jointOf);
  const next = {
    ...grid,
    joints: same(joints, grid.joints) ? grid.joints : joints,
    beams: same(beams, grid.beams) ? grid.beams : beams,
    actuators: same(actuators, grid.actuators) ? grid.actuators : actuators,
    fixed,
  };
  const unchanged = Object.keys(next).every((key) => next[key] === grid[key]);
  const vertexOf = follower(grid, next, jointOf, parts);
  const goals = followedGoals(document.goals, vertexOf);
  if (unchanged && goals === document.goals) return document;
  const moved = { ...document, grid: unchanged ? grid : next, goals };
  if (jointOf(grid.fixed) !== null || joints.length === 0) return moved;
  return seenFrom(moved, grid.joints[grid.fixed], joints[fixed]);
}

/** Return the document whose targets keep their places when the origin moves from one point to another. */
export function seenFrom(document, before, after) {
  const [dx, dy] = [before[0] - after[0], before[1] - after[1]];
  return dx === 0 && dy === 0 ? document : movedWishes(document, ([x, y, z]) => [x + dx, y + dy, z]);
}

/** Return the joint nearest to a point among those for which use(k), the first of several. */
export function nearestOf(joints, point, use) {
  let best = null;
  let least = Infinity;
  joints.forEach(([x, y], k) => {
    const away = Math.hypot(x - point[0], y - point[1]);
    if (away < least - 1e-6 && use(k)) [best, least] = [k, away];
  });
  return best;
}

/** Return the beams of a grid as pieces for `rebuild`. */
export function piecesOf(grid) {
  return grid.beams.map((ends, beam) => ({ ends, ratio: grid.actuators[beam], beam, from: 0, to: 1 }));
}

/** Return new numbers of the joints that stay, one after the other; null for the others. */
export function compact(stays) {
  let next = 0;
  return stays.map((stay) => (stay ? next++ : null));
}

/** Return whether two lists have the same entries. */
export function same(a, b) {
  return a.length === b.length && a.every((entry, k) => entry === b[k]);
}

function distinct(pieces, grid, count) {
  const beams = [];
  const actuators = [];
  const numbers = new Map();
  const parts = grid.beams.map(() => []);
  for (const { ends, ratio, beam, from = 0, to = 1 } of pieces) {
    const [i, j] = ends;
    if (i === j) continue;
    const key = Math.min(i, j) * count + Math.max(i, j);
    let number = numbers.get(key);
    if (number === undefined) {
      number = beams.length;
      numbers.set(key, number);
      const old = beam === null ? null : grid.beams[beam];
      beams.push(old && old[0] === i && old[1] === j ? old : [i, j]);
      actuators.push(ratio);
    }
    if (beam !== null) parts[beam].push({ number, from, to, reversed: beams[number][0] !== i });
  }
  return { beams, actuators, parts };
}

function fixedJoint(grid, joints, beams, jointOf) {
  if (joints.length === 0) return 0;
  const own = grid.joints.length > grid.fixed ? jointOf(grid.fixed) : 0;
  if (own !== null) return own;
  // A joint that bears something, else one with a beam, else any.
  const loops = lasting({ joints, beams }).joints;
  const choice = loops.size ? loops : new Set(beams.length ? beams.flat() : joints.keys());
  return nearestOf(joints, grid.joints[grid.fixed], (k) => choice.has(k));
}

/** Return a function that gives a vertex after the change; null where it is gone. */
function follower(before, after, jointOf, parts) {
  const corner = cornerFollower(before, after);
  return ([part, number, ...rest]) => {
    if (part === "beam") return onPart(rest, parts[number], after.beams);
    const k = jointOf(number);
    return k === null ? null : ["joint", k, corner(number, k, rest[0])];
  };
}

/** Return the vertex of a beam's parts that is nearest to what was at a section of the beam. */
function onPart([section, corner], parts, beams) {
  let best = null;
  let least = Infinity;
  for (const part of parts) {
    for (const [name, t] of Object.entries(WHERE)) {
      const away = Math.abs(part.from + t * (part.to - part.from) - WHERE[section]);
      if (away < least - 1e-9) [best, least] = [{ ...part, name }, away];
    }
  }
  if (!best) return null;
  const { number, reversed } = best;
  const name = reversed ? OTHER_END[best.name] : best.name;
  // What was in the middle of a beam and is now at a joint is at its centre.
  if (section === "middle" && name !== "middle" && corner === "centre")
    return ["joint", beams[number][name === "start" ? 0 : 1], "centre"];
  return ["beam", number, name, reversed && corner !== "centre" ? OTHER_SIDE[corner] : corner];
}
