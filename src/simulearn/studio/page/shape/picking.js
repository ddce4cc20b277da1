// Which part of a skin a ray meets first. Plain arrays, so that it is exact, fast and testable.

/** Return { part, point, distance } of the first triangle on a ray, or null.
 *
 * origin and direction: [x, y, z]. Parts whose sphere the ray misses are passed over.
 */
export function pick(skin, origin, direction) {
  let best = null;
  for (const part of skin.parts) {
    if (!mayHit(skin, part, origin, direction)) continue;
    for (let k = part.firstIndex; k < part.firstIndex + part.indexCount; k += 3) {
      const distance = hit(skin.storage, k, origin, direction);
      if (distance !== null && (!best || distance < best.distance)) best = { part, distance };
    }
  }
  if (!best) return null;
  return { ...best, point: origin.map((x, axis) => x + best.distance * direction[axis]) };
}

/** Whether the ray comes near the box of a part's vertices. */
function mayHit({ storage: { positions } }, { firstVertex, vertexCount }, origin, direction) {
  let [near, far] = [-Infinity, Infinity];
  for (let axis = 0; axis < 3; axis += 1) {
    let [low, high] = [Infinity, -Infinity];
    for (let v = firstVertex; v < firstVertex + vertexCount; v += 1) {
      const x = positions[3 * v + axis];
      if (x < low) low = x;
      if (x > high) high = x;
    }
    if (Math.abs(direction[axis]) < 1e-12) {
      if (origin[axis] < low || origin[axis] > high) return false;
      continue;
    }
    const a = (low - origin[axis]) / direction[axis];
    const b = (high - origin[axis]) / direction[axis];
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
    if (near > far) return false;
  }
  return true;
}

/** Return the distance along a ray to a triangle (Möller and Trumbore 1997), or null. */
function hit({ positions: p, index }, k, [ox, oy, oz], [dx, dy, dz]) {
  const [a, b, c] = [3 * index[k], 3 * index[k + 1], 3 * index[k + 2]];
  const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
  const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
  const [qx, qy, qz] = [dy * vz - dz * vy, dz * vx - dx * vz, dx * vy - dy * vx];
  const det = ux * qx + uy * qy + uz * qz;
  if (Math.abs(det) < 1e-12) return null;
  const [tx, ty, tz] = [ox - p[a], oy - p[a + 1], oz - p[a + 2]];
  const s = (tx * qx + ty * qy + tz * qz) / det;
  if (s < 0 || s > 1) return null;
  const [rx, ry, rz] = [ty * uz - tz * uy, tz * ux - tx * uz, tx * uy - ty * ux];
  const t = (dx * rx + dy * ry + dz * rz) / det;
  if (t < 0 || s + t > 1) return null;
  const distance = (vx * rx + vy * ry + vz * rz) / det;
  return distance > 0 ? distance : null;
}
