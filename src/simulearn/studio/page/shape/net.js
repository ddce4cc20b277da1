// The net that is drawn on a surface: lines at round distances.

const LINES = 12; // across a surface, about
const STEPS = [1, 2, 5, 10]; // times a power of ten

/** Return the distance of the net's lines on something so large: 1, 2 or 5 times a power of ten. */
export function cellOf(size) {
  const fine = size / LINES;
  const power = 10 ** Math.floor(Math.log10(fine));
  return power * STEPS.find((step) => step * power >= fine * 0.999);
}
