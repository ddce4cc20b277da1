// How far apart two results of one grid are, for example of the learned engine and of finite elements.

import { between, blend } from "./topology.js";
import { comparable } from "./values.js";

/** Return {distances, mean, max} in mm at a frame (fractions lie between two), or null if the results
 * are of different grids. distances: of the corners of all joints (J x 8), then of all beams' sections
 * (B x 3 x 4); the mean is over all of them, as the reported errors of the engines are.
 */
export function deviation(a, b, frame = 11) {
  if (!comparable(a, b)) return null;
  const moment = between(frame);
  const points = 8 * a.jointCount + 12 * a.beamCount;
  const distances = new Float32Array(points);
  let [sum, max, at] = [0, 0, 0];
  for (const [name, size] of [["joints", 24 * a.jointCount], ["beams", 36 * a.beamCount]]) {
    const [p, q] = [new Float64Array(size), new Float64Array(size)];
    blend(a[name], size, 0, size, moment, p);
    blend(b[name], size, 0, size, moment, q);
    for (let k = 0; k < size; k += 3) {
      const distance = Math.hypot(p[k] - q[k], p[k + 1] - q[k + 1], p[k + 2] - q[k + 2]);
      distances[at] = distance;
      at += 1;
      sum += distance;
      max = Math.max(max, distance);
    }
  }
  return { distances, mean: points ? sum / points : 0, max };
}
