// Lines that cross or touch are cut there, and the joints that this needs are added.

import { crossing, distance, nearestOnSegment, overlapping, rounded } from "./geometry.js";

/** Return pieces cut where active ones cross others, and where joints lie on them.
 *
 * joints: places; crossings without a joint near add one. pieces: {ends, ratio, beam, from, to}, as
 * `rebuild` takes them. active: numbers of pieces that are new or moved. used: joints that are.
 * Active pieces are cut at all joints within the tolerance, mm, others at used ones and crossings.
 * The first part of a cut piece keeps its place in the list; the others come last.
 */
export function weave(joints, pieces, active, used, tolerance) {
  const boxes = pieces.map(({ ends: [i, j] }) => boxOf(joints[i], joints[j]));
  const met = new Set(used);
  for (const a of active)
    for (let b = 0; b < pieces.length; b += 1) {
      if (b === a || (b < a && active.has(b)) || apart(boxes[a], boxes[b])) continue;
      const point = meeting(joints, pieces[a].ends, pieces[b].ends, tolerance);
      if (point) met.add(jointAt(joints, point, tolerance));
    }
  const cuts = new Map();
  const [all, some] = [[...joints.keys()], [...met]];
  pieces.forEach(({ ends }, b) => {
    const box = grown(boxes[b], tolerance);
    const found = jointsOn(joints, ends, box, active.has(b) ? all : some, tolerance);
    if (found.length) cuts.set(b, found);
  });
  return cut(pieces, cuts);
}

/** Return pieces cut at joints: cuts has lists of {joint, t}, in order, by number of piece. */
export function cut(pieces, cuts) {
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

/** Return the joint near a point; a new one where there is none. */
export function jointAt(joints, point, tolerance) {
  return nearJoint(joints, point, tolerance) ?? joints.push(point.map(rounded)) - 1;
}

/** Return the joint nearest to a point within a tolerance, of those for which use(k), or null. */
export function nearJoint(joints, point, tolerance, use = null) {
  let best = null;
  let least = tolerance;
  for (let k = 0; k < joints.length; k += 1) {
    const away = distance(joints[k], point);
    if (away <= least && (best === null || away < least) && (!use || use(k))) [best, least] = [k, away];
  }
  return best;
}

/** Return the point where two lines cross, away from joints that both have; or null. */
function meeting(joints, [i, j], [m, n], tolerance) {
  if (i === m || i === n || j === m || j === n) return null;
  const ends = [joints[i], joints[j], joints[m], joints[n]];
  const point = crossing(...ends);
  // Where lines run over each other, the ends of each lie on the other: no more joints are needed.
  return point && !overlapping(...ends, tolerance) ? point : null;
}

/** Return the joints {joint, t} that lie on a line between its ends, in order. */
function jointsOn(joints, [i, j], box, candidates, tolerance) {
  const [p, q] = [joints[i], joints[j]];
  const found = [];
  for (const k of candidates) {
    const point = joints[k];
    if (k === i || k === j || outside(point, box)) continue;
    const { t, distance: away } = nearestOnSegment(point, p, q);
    const between = t > 0 && t < 1 && away <= tolerance;
    if (between && distance(point, p) > tolerance && distance(point, q) > tolerance)
      found.push({ joint: k, t });
  }
  return found.sort((a, b) => a.t - b.t);
}

/** Return {left, low, right, high} around two points. */
function boxOf([x, y], [u, v]) {
  return { left: Math.min(x, u), low: Math.min(y, v), right: Math.max(x, u), high: Math.max(y, v) };
}

function grown({ left, low, right, high }, by) {
  return { left: left - by, low: low - by, right: right + by, high: high + by };
}

function apart(a, b) {
  return a.right < b.left || b.right < a.left || a.high < b.low || b.high < a.low;
}

function outside(point, box) {
  return point[0] < box.left || point[0] > box.right || point[1] < box.low || point[1] > box.high;
}
