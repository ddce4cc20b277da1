// Points in the plane, mm: what drawing needs beside document/measure.js.

/** Return the vector from q to p. */
export function minus([px, py], [qx, qy]) {
  return [px - qx, py - qy];
}

/** Return the point at a length (mm) and an angle (degrees from +x) from p. */
export function polar([x, y], length, angle) {
  const radians = (angle * Math.PI) / 180;
  return [x + length * Math.cos(radians), y + length * Math.sin(radians)];
}

/** Return whether two points are the same but for rounding. */
export function samePoint([px, py], [qx, qy]) {
  return Math.hypot(px - qx, py - qy) < 1e-4;
}
