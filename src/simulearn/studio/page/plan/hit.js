// Which joint or beam lies under the pointer. Found by distance and not by the elements of the page,
// so that what is small on the screen can still be grasped, by a finger too.

import { nearestBeam, nearestJoint } from "../document/measure.js";

/** Return {joint} or {beam} at a point in mm, or null; joints win over beams.
 *
 * reach: mm around a joint or a beam's axis. width: mm, beams are hit all over their width.
 */
export function partAt(grid, point, reach, width) {
  const joint = nearestJoint(grid, point);
  if (joint && joint.distance <= reach) return { joint: joint.number };
  const beam = nearestBeam(grid, point);
  return beam && beam.distance <= Math.max(reach * 0.7, width / 2) ? { beam: beam.number } : null;
}

/** Return {joints, beams} inside the box between two corners: joints in it, beams all in it. */
export function partsInBox(grid, [a, b]) {
  const [left, right] = [Math.min(a[0], b[0]), Math.max(a[0], b[0])];
  const [low, high] = [Math.min(a[1], b[1]), Math.max(a[1], b[1])];
  const inside = grid.joints.map(([x, y]) => x >= left && x <= right && y >= low && y <= high);
  return {
    joints: inside.flatMap((is, k) => (is ? [k] : [])),
    beams: grid.beams.flatMap(([i, j], n) => (inside[i] && inside[j] ? [n] : [])),
  };
}

/** Return whether a part is in a selection. */
export function isSelected(selection, part) {
  if (!part) return false;
  const { joints, beams } = selection;
  return part.joint !== undefined ? joints.includes(part.joint) : beams.includes(part.beam);
}

/** Return the selection with a part added, or without it where it was in. */
export function toggled(selection, part) {
  const flip = (list, n) => (list.includes(n) ? list.filter((m) => m !== n) : [...list, n]);
  return part.joint !== undefined
    ? { ...selection, joints: flip(selection.joints, part.joint) }
    : { ...selection, beams: flip(selection.beams, part.beam) };
}

/** Return the selection of one part alone. */
export function only(part) {
  return part.joint !== undefined ? { joints: [part.joint], beams: [] } : { joints: [], beams: [part.beam] };
}
