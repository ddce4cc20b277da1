// Lengths, angles and what is nearest, in a grid.

import { angle, distance, nearestOnSegment } from "./geometry.js";

export { angle, between, crossing, distance, nearestOnSegment } from "./geometry.js";

/** Return the ends of beam b: [[x, y], [x, y]]. */
export function beamEnds(grid, b) {
  return grid.beams[b].map((k) => grid.joints[k]);
}

/** Return the length of beam b between the centres of its joints, mm. */
export function beamLength(grid, b) {
  return distance(...beamEnds(grid, b));
}

/** Return the direction of beam b, degrees from +x. */
export function beamAngle(grid, b) {
  return angle(...beamEnds(grid, b));
}

/** Return the beams that meet at joint k. */
export function beamsAt(grid, k) {
  return grid.beams.flatMap((ends, b) => (ends.includes(k) ? [b] : []));
}

/** Return {min, max, middle: [x, y], width, height} of the joints, mm; null where there are none. */
export function bounds(grid) {
  if (grid.joints.length === 0) return null;
  const min = [Infinity, Infinity];
  const max = [-Infinity, -Infinity];
  for (const point of grid.joints)
    for (const axis of [0, 1]) {
      min[axis] = Math.min(min[axis], point[axis]);
      max[axis] = Math.max(max[axis], point[axis]);
    }
  const [width, height] = [max[0] - min[0], max[1] - min[1]];
  return { min, max, middle: [min[0] + width / 2, min[1] + height / 2], width, height };
}

/** Return the joint nearest to a point: {number, distance, point}; null where there is none.
 *
 * exclude: numbers that do not count.
 */
export function nearestJoint(grid, point, { exclude = [] } = {}) {
  let best = null;
  grid.joints.forEach((place, number) => {
    const away = distance(place, point);
    if ((best === null || away < best.distance) && !exclude.includes(number))
      best = { number, distance: away, point: place };
  });
  return best;
}

/** Return the beam nearest to a point: {number, distance, t in [0, 1], point}; null where there is none.
 *
 * exclude: beams that do not count.
 */
export function nearestBeam(grid, point, { exclude = [] } = {}) {
  let best = null;
  grid.beams.forEach(([i, j], number) => {
    const found = nearestOnSegment(point, grid.joints[i], grid.joints[j]);
    if ((best === null || found.distance < best.distance) && !exclude.includes(number))
      best = { number, ...found };
  });
  return best;
}
