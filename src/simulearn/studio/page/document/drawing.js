// From drawn lines to joints and beams: ends that nearly meet are joined, crossings become joints.
// The rule is that of grid/sketch.py, for a line that is added to a grid.

import { between, crossing, distance, isPoint, nearestOnSegment, overlapping, rounded } from "./geometry.js";
import { compact, piecesOf } from "./edit.js";
import { rebuild } from "./numbering.js";

const TOLERANCE = 1; // mm; nearer points are one, as in grid/sketch.py

/** Add a polyline: its corners, ends, crossings and touches become joints.
 *
 * Beams that it crosses or touches are split and keep their ratios; where it runs over beams, they
 * stay. New beams have no actuator. New joints have the last numbers.
 */
export function addPolyline(document, points, { tolerance = TOLERANCE } = {}) {
  const { grid } = document;
  const joints = [...grid.joints];
  const pieces = piecesOf(grid);
  const corners = points.filter(isPoint).map((point) => jointFor(joints, pieces, point, tolerance));
  const active = new Set();
  for (let k = 1; k < corners.length; k += 1) {
    if (corners[k - 1] === corners[k]) continue;
    active.add(pieces.length);
    pieces.push({ ends: [corners[k - 1], corners[k]], ratio: 0, beam: null, from: 0, to: 1 });
  }
  if (active.size === 0) return document;
  const cut = weave(joints, pieces, active, new Set(corners), tolerance);
  return rebuild(document, joints, cut, (k) => k);
}

/** Split beam b at t in (0, 1) by a joint, which has the last number; both parts keep the ratio. */
export function splitBeam(document, b, t = 0.5) {
  const { grid } = document;
  if (!(b in grid.beams) || !(t > 0 && t < 1)) return document;
  const [i, j] = grid.beams[b];
  const joints = [...grid.joints, between(grid.joints[i], grid.joints[j], t).map(rounded)];
  const pieces = piecesOf(grid);
  return rebuild(document, joints, cutAll(pieces, new Map([[b, [{ joint: joints.length - 1, t }]]])), (k) => k);
}

/** Split beam b at the place nearest to a point. */
export function addJointOnBeam(document, b, point) {
  const { grid } = document;
  if (!(b in grid.beams) || !isPoint(point)) return document;
  const [i, j] = grid.beams[b];
  return splitBeam(document, b, nearestOnSegment(point, grid.joints[i], grid.joints[j]).t);
}

/** Join what joints that have moved now meet: other joints, beams that they or their beams touch or cross.
 *
 * A moved joint within a tolerance of one that has not becomes that one.
 */
export function settle(document, moved, tolerance = TOLERANCE) {
  const { grid } = document;
  const movers = new Set(moved.filter((k) => k in grid.joints));
  if (movers.size === 0) return document;
  const target = grid.joints.map((_, k) => k);
  for (const k of movers) {
    const other = nearest(grid.joints, grid.joints[k], tolerance, (n) => !movers.has(n));
    if (other !== null) target[k] = other;
  }
  const number = compact(target.map((n, k) => n === k));
  target.forEach((n, k) => {
    number[k] = number[n];
  });
  const joints = grid.joints.filter((_, k) => target[k] === k);
  const pieces = piecesOf(grid).map((piece) => ({ ...piece, ends: piece.ends.map((k) => number[k]) }));
  const active = new Set([...pieces.keys()].filter((b) => grid.beams[b].some((k) => movers.has(k))));
  const used = new Set([...movers].map((k) => number[k]));
  return rebuild(document, joints, weave(joints, pieces, active, used, tolerance), (k) => number[k]);
}

/** Return the pieces cut where active ones cross others and where joints lie on them.
 *
 * Active pieces are cut at all joints within the tolerance, others at the used joints. Crossings
 * without a joint get one: `joints` grows.
 */
export function weave(joints, pieces, active, used, tolerance) {
  const crossings = new Set(used);
  for (const a of active)
    pieces.forEach((piece, b) => {
      if (b === a || (active.has(b) && b < a)) return;
      const point = meeting(joints, pieces[a].ends, piece.ends, tolerance);
      if (point) crossings.add(jointAt(joints, point, tolerance));
    });
  const cuts = new Map();
  pieces.forEach((piece, b) => {
    const found = jointsOn(joints, piece.ends, active.has(b) ? joints.keys() : crossings, tolerance);
    if (found.length) cuts.set(b, found);
  });
  return cutAll(pieces, cuts);
}

/** Return pieces with some cut at joints {joint, t}; the first part keeps its place in the list. */
function cutAll(pieces, cuts) {
  const more = [];
  const first = pieces.map((piece, b) => {
    const found = cuts.get(b);
    if (!found) return piece;
    const places = [{ joint: piece.ends[0], t: 0 }, ...found, { joint: piece.ends[1], t: 1 }];
    const parts = places.slice(1).map((to, k) => ({
      ...piece, ends: [places[k].joint, to.joint], from: places[k].t, to: to.t,
    }));
    more.push(...parts.slice(1));
    return parts[0];
  });
  return [...first, ...more];
}

/** Return the point where two pieces cross away from common joints, or null. */
function meeting(joints, [i, j], [m, n], tolerance) {
  if (i === m || i === n || j === m || j === n) return null;
  const [p, q, r, s] = [joints[i], joints[j], joints[m], joints[n]];
  if (apart(p[0], q[0], r[0], s[0]) || apart(p[1], q[1], r[1], s[1])) return null;
  const point = crossing(p, q, r, s);
  return point && !overlapping(p, q, r, s, tolerance) ? point : null;
}

/** Return whether the intervals a b and c d have no point in common. */
function apart(a, b, c, d) {
  return Math.max(a, b) < Math.min(c, d) || Math.max(c, d) < Math.min(a, b);
}

/** Return the joints {joint, t} that lie on a piece between its ends, in order. */
function jointsOn(joints, [i, j], candidates, tolerance) {
  const [p, q] = [joints[i], joints[j]];
  const found = [];
  for (const k of candidates) {
    if (k === i || k === j) continue;
    const point = joints[k];
    if (apart(p[0], q[0], point[0] - tolerance, point[0] + tolerance)) continue;
    const { t, distance: away } = nearestOnSegment(point, p, q);
    if (t > 0 && t < 1 && away <= tolerance && distance(point, p) > tolerance && distance(point, q) > tolerance)
      found.push({ joint: k, t });
  }
  return found.sort((a, b) => a.t - b.t);
}

/** Return the joint for a drawn point: one near it, or a new one, on a beam where one is near. */
function jointFor(joints, pieces, point, tolerance) {
  const near = nearest(joints, point, tolerance);
  if (near !== null) return near;
  let place = point;
  let least = tolerance;
  for (const { ends: [i, j] } of pieces) {
    const found = nearestOnSegment(point, joints[i], joints[j]);
    if (found.distance <= least) [place, least] = [found.point, found.distance];
  }
  return jointAt(joints, place, tolerance);
}

/** Return the joint near a point, a new one where there is none. */
function jointAt(joints, point, tolerance) {
  return nearest(joints, point, tolerance) ?? joints.push(point.map(rounded)) - 1;
}

function nearest(joints, point, tolerance, use = () => true) {
  let best = null;
  let least = tolerance;
  for (let k = 0; k < joints.length; k += 1) {
    const away = distance(joints[k], point);
    if (away <= least && (best === null || away < least) && use(k)) [best, least] = [k, away];
  }
  return best;
}
