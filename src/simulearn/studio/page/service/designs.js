// Designs that the server made from one of ours: put back where ours lies, and what they change.

import { same } from "../document/numbering.js";
import { withGrid } from "../document/document.js";

const EXACT = 1e-6; // mm: finer differences come from moving the fixed joint to the origin and back

/** Return a grid of the server, whose fixed joint is the origin, at the place of one it was made from.
 *
 * Joints that were not moved keep their numbers exactly.
 */
export function placedLike(grid, made) {
  const [x, y] = grid.joints[grid.fixed];
  const [u, v] = made.joints[made.fixed];
  const joints = made.joints.map((joint, k) => {
    const place = [joint[0] - u + x, joint[1] - v + y];
    const before = grid.joints[k];
    const still = before && Math.hypot(place[0] - before[0], place[1] - before[1]) < EXACT;
    return still ? before : place.map((value) => Number(value.toFixed(6)));
  });
  return { ...grid, joints, beams: made.beams, actuators: made.actuators };
}

/** Return what a design changes: {joints: [{k, by: [dx, dy]}], actuators: [{b, from, to}]}. */
export function changesOf(grid, made) {
  const joints = [];
  made.joints.forEach(([x, y], k) => {
    const by = [x - grid.joints[k][0], y - grid.joints[k][1]];
    if (Math.hypot(...by) > EXACT) joints.push({ k, by });
  });
  const actuators = [];
  made.actuators.forEach((to, b) => {
    const from = grid.actuators[b];
    if (Math.abs(to - from) > EXACT) actuators.push({ b, from, to });
  });
  return { joints, actuators };
}

const wishesOf = ({ goals, surfaces, pose }) => ({ goals, surfaces, pose });

/** Return the document with a design that was made from `origin`, an earlier state of it.
 *
 * The goals stay, unless joints or beams have been numbered anew since: then they are the origin's.
 */
export function withDesign(document, origin, grid) {
  const alike = document.grid.joints.length === grid.joints.length
    && same(document.grid.beams.flat(), grid.beams.flat());
  return withGrid(alike ? document : { ...document, ...wishesOf(origin) }, grid);
}
