// From drawn lines to joints and beams: ends that nearly meet are joined, crossings become joints.
// The rule is that of grid/sketch.py, for a line that is added to a grid.

import { compact, piecesOf, rebuild } from "./numbering.js";
import { between, isPoint, nearestOnSegment, rounded } from "./geometry.js";
import { cut, jointAt, nearJoint, weave } from "./weaving.js";

export const TOLERANCE = 1; // mm; nearer points are one, as in grid/sketch.py

/** Add a polyline: its corners, ends, crossings and touches become joints.
 *
 * Beams that it crosses or touches are split and keep their ratios; where it runs over beams, they
 * stay. New beams have no actuator. New joints have the last numbers. Points that are none are
 * passed over.
 */
export function addPolyline(document, points, { tolerance = TOLERANCE } = {}) {
  const { grid } = document;
  const joints = [...grid.joints];
  const pieces = piecesOf(grid);
  const corners = points.filter(isPoint).map((point) => jointFor(joints, grid, point, tolerance));
  const active = new Set();
  for (let k = 1; k < corners.length; k += 1) {
    if (corners[k - 1] === corners[k]) continue;
    active.add(pieces.length);
    pieces.push({ ends: [corners[k - 1], corners[k]], ratio: 0, beam: null });
  }
  if (active.size === 0) return document;
  const parts = weave(joints, pieces, active, new Set(corners), tolerance);
  return rebuild(document, joints, parts, (k) => k);
}

/** Split beam b at t in (0, 1) by a joint, which has the last number; both parts keep the ratio. */
export function splitBeam(document, b, t = 0.5) {
  const { grid } = document;
  if (!(b in grid.beams) || !(t > 0 && t < 1)) return document;
  const [p, q] = grid.beams[b].map((k) => grid.joints[k]);
  const joints = [...grid.joints, between(p, q, t).map(rounded)];
  const parts = cut(piecesOf(grid), new Map([[b, [{ joint: grid.joints.length, t }]]]));
  return rebuild(document, joints, parts, (k) => k);
}

/** Split beam b at the place nearest to a point. */
export function addJointOnBeam(document, b, point) {
  const { grid } = document;
  if (!(b in grid.beams) || !isPoint(point)) return document;
  const [p, q] = grid.beams[b].map((k) => grid.joints[k]);
  return splitBeam(document, b, nearestOnSegment(point, p, q).t);
}

/** Join what moved joints now meet: other joints, and beams that they or their beams touch or cross.
 *
 * A moved joint within the tolerance of one that has not moved becomes that one. In a drag, settle
 * the document of its beginning with the joints moved so far: what is joined in passing comes apart.
 */
export function settle(document, moved, tolerance = TOLERANCE) {
  const { grid } = document;
  const movers = new Set(moved.filter((k) => k in grid.joints));
  if (movers.size === 0) return document;
  const same = grid.joints.map((place, k) =>
    (movers.has(k) ? nearJoint(grid.joints, place, tolerance, (n) => !movers.has(n)) : null) ?? k);
  const stays = compact(same.map((n, k) => n === k));
  const number = same.map((n) => stays[n]);
  const joints = grid.joints.filter((_, k) => same[k] === k);
  const pieces = piecesOf(grid).map((piece) => ({ ...piece, ends: piece.ends.map((k) => number[k]) }));
  const active = new Set(pieces.keys());
  grid.beams.forEach((ends, b) => {
    if (!ends.some((k) => movers.has(k))) active.delete(b);
  });
  const used = new Set([...movers].map((k) => number[k]));
  const parts = weave(joints, pieces, active, used, tolerance);
  return rebuild(document, joints, parts, (k) => number[k]);
}

/** Return the joint for a drawn point: one near it, or a new one, on a beam where one is near. */
function jointFor(joints, grid, point, tolerance) {
  const near = nearJoint(joints, point, tolerance);
  if (near !== null) return near;
  let place = point;
  let least = tolerance;
  for (const [i, j] of grid.beams) {
    const found = nearestOnSegment(point, joints[i], joints[j]);
    if (found.distance <= least) [place, least] = [found.point, found.distance];
  }
  return jointAt(joints, place, tolerance);
}
