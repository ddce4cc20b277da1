// Numbers of beams and joints as the plan shows them.

import { beamLength } from "../document/measure.js";

/** Return whether numbers of parts mean the same in two grids. */
export function sameTopology(a, b) {
  if (a.joints.length !== b.joints.length || a.beams.length !== b.beams.length) return false;
  return a.beams === b.beams || a.beams.every(([i, j], n) => i === b.beams[n][0] && j === b.beams[n][1]);
}

/** Return the length of each beam between the sides of its joints, mm.
 *
 * Those of the last check where it is of this grid; after a joint has moved, changed as the whole
 * lengths have changed; of beams that are new, with half a width off at each end.
 */
export function netLengths(grid, check, width) {
  const known = check && sameTopology(grid, check.document.grid) ? check.netLengths ?? {} : {};
  return grid.beams.map((_, b) => {
    const length = beamLength(grid, b);
    if (known[b] === undefined) return Math.max(0, length - width);
    return Math.max(0, known[b] + length - beamLength(check.document.grid, b));
  });
}

/** Return the height of a joint's centre in the last frame, mm, or null where it is not known. */
export function jointHeight(answer, grid, k) {
  if (!answer || answer.document.grid !== grid) return null;
  const { result } = answer;
  const n = result.joint_numbers ? result.joint_numbers.indexOf(k) : k;
  if (n < 0) return null;
  const count = result.jointCount;
  const last = result.joints.length / (count * 24) - 1;
  let sum = 0;
  for (let corner = 0; corner < 8; corner++) sum += result.joints[(last * count + n) * 24 + corner * 3 + 2];
  return sum / 8;
}

/** Return the ratio that beams have in common, or null. */
export function commonRatio(grid, beams) {
  const [first, ...others] = beams.map((b) => grid.actuators[b]);
  return others.every((ratio) => ratio === first) ? first ?? null : null;
}

/** Return a number with one decimal at most, never "-0". */
export function shown(x, digits = 1) {
  const text = x.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}
