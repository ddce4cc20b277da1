// Changes of a document. Each function returns the changed document, or the same one where nothing
// changes; numbers that no joint or beam has are passed over.

import { emptyDocument, readGrid } from "./document.js";
import { isNumber, isPoint, rounded } from "./geometry.js";
import { jointsOf } from "./moving.js";
import { compact, piecesOf, rebuild, seenFrom } from "./numbering.js";

export { jointsOf, mirror, moveJoints, placeJoint, rotate, scale, setBeamLength } from "./moving.js";

const STEP = 0.25; // of a ratio

/** Remove joints and beams; beams of removed joints go too, and joints that lose their last beam.
 *
 * Where the fixed joint goes, the nearest joint that is left with a beam is fixed.
 */
export function removeParts(document, { joints = [], beams = [] }) {
  const { grid } = document;
  const [goneJoints, goneBeams] = [new Set(joints), new Set(beams)];
  const stays = grid.beams.map((ends, b) => !goneBeams.has(b) && !ends.some((k) => goneJoints.has(k)));
  const used = new Set(grid.beams.filter((_, b) => stays[b]).flat());
  grid.beams.forEach((ends, b) => {
    if (!stays[b]) for (const k of ends) if (!used.has(k)) goneJoints.add(k);
  });
  const pieces = piecesOf(grid).filter((_, b) => stays[b]);
  return renumber(document, pieces, compact(grid.joints.map((_, k) => !goneJoints.has(k))));
}

/** Make joint j the same as joint i, which keeps its place; a beam between them goes. */
export function mergeJoints(document, i, j) {
  const { grid } = document;
  if (i === j || !(i in grid.joints) || !(j in grid.joints)) return document;
  const number = compact(grid.joints.map((_, k) => k !== j));
  return renumber(document, piecesOf(grid), number.with(j, number[i]), number);
}

/** Set the ratio of beams, in [-1, 1]; + lifts their ends. */
export function setActuators(document, beams, ratio) {
  return isNumber(ratio) ? actuate(document, beams, () => ratio) : document;
}

/** Change the ratio of beams to the next quarter above (1) or below (-1). */
export function stepActuators(document, beams, direction) {
  const round = direction > 0 ? Math.floor : Math.ceil;
  const sign = Math.sign(direction);
  // A ratio that is rounding away from a quarter counts as that quarter.
  return actuate(document, beams, (ratio) => (round(ratio / STEP + sign * 1e-6) + sign) * STEP);
}

/** Exchange the active and passive halves of beams. */
export function flipActuators(document, beams) {
  return actuate(document, beams, (ratio) => -ratio);
}

/** Fix joint k; targets keep their places in the plan. */
export function setFixed(document, k) {
  const { grid } = document;
  if (k === grid.fixed || !(k in grid.joints)) return document;
  const next = { ...document, grid: { ...grid, fixed: k } };
  return seenFrom(next, grid.joints[grid.fixed], grid.joints[k]);
}

/** Return the selected parts, with the beams between selected joints, to be pasted. */
export function copyParts(document, selection) {
  const { grid } = document;
  const numbers = jointsOf(grid, selection);
  const some = selection?.joints?.length || selection?.beams?.length;
  const selected = new Set(some ? selection.joints : numbers);
  const chosen = new Set(some ? selection.beams : []);
  const place = new Map(numbers.map((k, n) => [k, n]));
  const beams = grid.beams.map((_, b) => b).filter((b) =>
    chosen.has(b) || grid.beams[b].every((k) => selected.has(k)));
  return {
    joints: numbers.map((k) => grid.joints[k]),
    beams: beams.map((b) => grid.beams[b].map((k) => place.get(k))),
    actuators: beams.map((b) => grid.actuators[b]),
  };
}

/** Add copied parts, their middle at a point; theirs are the last numbers.
 *
 * Nothing is joined to what is there: `settle` does that for the new joints.
 */
export function pasteParts(document, clip, at) {
  const { grid } = document;
  if (!isClip(clip) || !isPoint(at)) return document;
  const [dx, dy] = [0, 1].map((axis) => {
    const values = clip.joints.map((point) => point[axis]);
    return at[axis] - (Math.min(...values) + Math.max(...values)) / 2;
  });
  const added = clip.joints.map(([x, y]) => [rounded(x + dx), rounded(y + dy)]);
  if (!added.every(isPoint)) return document;
  const first = grid.joints.length;
  const beams = clip.beams.map(([i, j]) => [i + first, j + first]);
  return {
    ...document,
    grid: {
      ...grid,
      joints: [...grid.joints, ...added],
      beams: [...grid.beams, ...beams],
      actuators: [...grid.actuators, ...clip.actuators],
    },
  };
}

/** Return whether data are parts as `copyParts` gives them, at least one. */
function isClip(data) {
  try {
    return readGrid({ ...emptyDocument().grid, ...data }).joints.length > 0;
  } catch {
    return false;
  }
}

/** Return the document with pieces between joints that have new numbers, null where they go.
 *
 * stays: the new numbers of the joints that keep their places.
 */
function renumber(document, pieces, number, stays = number) {
  const left = document.grid.joints.filter((_, k) => stays[k] !== null);
  const moved = pieces.map((piece) => ({ ...piece, ends: piece.ends.map((k) => number[k]) }));
  return rebuild(document, left, moved, (k) => number[k]);
}

function actuate(document, beams, ratioOf) {
  const { grid } = document;
  const actuators = [...grid.actuators];
  let changed = false;
  for (const b of new Set(beams)) {
    if (!(b in actuators)) continue;
    const ratio = rounded(Math.min(1, Math.max(-1, ratioOf(actuators[b]))));
    changed ||= ratio !== actuators[b];
    actuators[b] = ratio;
  }
  return changed ? { ...document, grid: { ...grid, actuators } } : document;
}
