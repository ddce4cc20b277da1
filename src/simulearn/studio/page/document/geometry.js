// Points [x, y] in the plane, mm: distances, nearest places, crossings.

export const FARTHEST = 1e5; // mm from the origin; the server takes no coordinate beyond
const DIGITS = 1e6; // coordinates have six decimals, so that 0.1 + 0.2 is 0.3

/** Return whether a value is a number that a document may hold. */
export function isNumber(value) {
  return typeof value === "number" && Number.isFinite(value);
}

/** Return whether a value is a list of so many coordinates, mm. */
export function isPlace(value, dimensions) {
  const inside = (x) => isNumber(x) && Math.abs(x) <= FARTHEST;
  return Array.isArray(value) && value.length === dimensions && value.every(inside);
}

/** Return whether a value is a point of the plane that a grid may have. */
export function isPoint(value) {
  return isPlace(value, 2);
}

/** Return a number with six decimals, never -0. */
export function rounded(x) {
  return Math.round(x * DIGITS) / DIGITS + 0;
}

/** Return a number with six decimals that is no farther from 0 than a coordinate may be. */
export function limited(x) {
  return rounded(Math.min(FARTHEST, Math.max(-FARTHEST, x)));
}

/** Return the distance of two points. */
export function distance(p, q) {
  const dx = q[0] - p[0];
  const dy = q[1] - p[1];
  return Math.sqrt(dx * dx + dy * dy); // several times faster than Math.hypot
}

/** Return the direction from p to q, degrees from +x in (-180, 180]. */
export function angle([x, y], [u, v]) {
  return (Math.atan2(v - y + 0, u - x + 0) * 180) / Math.PI;
}

/** Return the point at t from p (0) to q (1). */
export function between(p, q, t) {
  return [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])];
}

/** Return the place of the segment p q nearest to a point: {t in [0, 1], point, distance}. */
export function nearestOnSegment(point, p, q) {
  const dx = q[0] - p[0];
  const dy = q[1] - p[1];
  const square = dx * dx + dy * dy;
  const along = square > 0 ? ((point[0] - p[0]) * dx + (point[1] - p[1]) * dy) / square : 0;
  const t = Math.min(1, Math.max(0, along));
  const place = between(p, q, t);
  return { t, point: place, distance: distance(point, place) };
}

/** Return the point where the segments p q and r s cross, or null; parallel ones do not. */
export function crossing(p, q, r, s) {
  const [ax, ay, bx, by] = [q[0] - p[0], q[1] - p[1], s[0] - r[0], s[1] - r[1]];
  const turn = ax * by - ay * bx;
  if (turn === 0) return null;
  const [cx, cy] = [r[0] - p[0], r[1] - p[1]];
  const t = (cx * by - cy * bx) / turn;
  const u = (cx * ay - cy * ax) / turn;
  return t >= 0 && t <= 1 && u >= 0 && u <= 1 ? between(p, q, t) : null;
}

/** Return whether segments run within a tolerance of each other over some length. */
export function overlapping(p, q, r, s, tolerance) {
  const ends = [];
  for (const [point, a, b] of [[p, r, s], [q, r, s], [r, p, q], [s, p, q]])
    if (nearestOnSegment(point, a, b).distance <= tolerance) ends.push(point);
  return ends.some((end) => distance(end, ends[0]) > tolerance);
}
