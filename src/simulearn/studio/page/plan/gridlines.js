// The lines of the drawing grid and the scale bar: which distances suit a zoom.

import { toPlan, toScreen } from "./camera.js";

const LEAST_GAP = 9; // px between minor lines; closer ones are noise
const STEPS = [1, 2, 5]; // each times a power of ten
const MAJOR = 5; // every fifth line is a major one: 10 and 50 mm at usual zooms

/** Return the least "round" number (1, 2 or 5 times a power of ten) that is at least `least`. */
export function roundUp(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  const step = STEPS.find((s) => s * power >= least * (1 - 1e-9)) ?? 10;
  return step * power;
}

/** Return the distance between minor lines in mm: 10 at usual zooms, else what suits. */
export function gridStep(scale) {
  const least = LEAST_GAP / scale;
  if (least <= 10 && least > 1) return 10;
  return roundUp(least);
}

/** Return the paths {minor, major} of the lines in a view, on whole pixels so that they are crisp. */
export function gridLines(camera, { width, height }) {
  const step = gridStep(camera.scale);
  const [left, top] = toPlan(camera, [0, 0]);
  const [right, bottom] = toPlan(camera, [width, height]);
  const paths = { minor: "", major: "" };
  for (let n = Math.ceil(left / step); n <= right / step; n++) {
    const x = Math.round(toScreen(camera, [n * step, 0])[0]) + 0.5;
    paths[n % MAJOR === 0 ? "major" : "minor"] += `M${x} 0V${height}`;
  }
  for (let n = Math.ceil(bottom / step); n <= top / step; n++) {
    const y = Math.round(toScreen(camera, [0, n * step])[1]) + 0.5;
    paths[n % MAJOR === 0 ? "major" : "minor"] += `M0 ${y}H${width}`;
  }
  return paths;
}

/** Return the scale bar {mm, px}: a round length of some 60 to 150 px. */
export function scaleBar(scale) {
  const mm = roundUp(60 / scale);
  return { mm, px: mm * scale };
}
