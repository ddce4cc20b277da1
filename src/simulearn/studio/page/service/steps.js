// The steps of a search as a curve to draw and as designs to go back to.

import { placedLike } from "./designs.js";

export const ANSWERS = -2; // the phase in which other answers are looked for; see the library
const MOST_POINTS = 300; // of the curve; more cannot be told apart
const MOST_STAGES = 60; // of more designs, every second or third is left out

/** Return the steps to the best design, without those to other answers. */
export const ofBest = (steps) => steps.filter(({ phase }) => phase !== ANSWERS);

/** Return the least of 1, 2, 3, 4, 6, 8, 10 times a power of ten that is at least `most`. */
export function roundUp(most) {
  if (!(most > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(most));
  const values = [1, 2, 3, 4, 6, 8, 10].map((n) => Number((n * power).toPrecision(2)));
  return values.find((value) => value >= most * (1 - 1e-9));
}

/** Return the line of the best error so far, as steps: {points: [[designs, mm], ...], corrections}.
 *
 * corrections: the numbers of designs at which finite elements moved the targets; the error then is
 * measured against those, and begins anew.
 */
export function bestSoFar(all) {
  const steps = ofBest(all);
  const points = [];
  const corrections = [];
  let [best, phase] = [Infinity, steps[0]?.phase];
  for (const { designs, error_mm: error, phase: now } of steps) {
    if (now === phase && error >= best) continue;
    if (best < Infinity) points.push([designs, best]);
    if (now !== phase) corrections.push(designs);
    [best, phase] = [error, now];
    points.push([designs, best]);
  }
  if (steps.length) points.push([steps.at(-1).designs, best]);
  const stride = Math.ceil(points.length / MOST_POINTS);
  return { points: points.filter((_, k) => k % stride === 0 || k === points.length - 1), corrections };
}

/** Return the designs on the way of a search, each different from the one before; the best is last.
 *
 * grid: the design that it began with. shape: of the best one, or null.
 */
export function stagesOf(grid, all, best, shape) {
  const steps = ofBest(all);
  const changed = steps.filter((step, n) => n === 0 || differs(step.grid, steps[n - 1].grid));
  const stride = Math.ceil(changed.length / MOST_STAGES);
  const stages = changed.filter((step, n) => n % stride === 0).map((step) => ({
    grid: placedLike(grid, step.grid), error: step.error_mm, designs: step.designs, result: null,
  }));
  const last = { grid: best.grid, error: best.error_mm, designs: best.designs, result: shape };
  while (stages.length && !differs(stages.at(-1).grid, best.grid)) stages.pop();
  return [...stages, last];
}

/** Return the result of a search that ended without one: the design of its last step, not checked. */
export function bestOf(grid, all) {
  const steps = ofBest(all);
  const last = steps.at(-1);
  return {
    grid: placedLike(grid, last.grid), start_mm: steps[0].error_mm, error_mm: last.error_mm,
    error_fea_mm: null, apart_mm: null, agrees: null, designs: last.designs, seconds: last.seconds,
    warnings: [],
  };
}

/** Return the several designs that a search answers with, to be shown and taken; [] of a single one.
 *
 * Each is {grid, error, byFea, actuators, length: mm, seconds: to print or null, within: share of prints
 * or null, beaten: whether another is as good in everything, collides: whether parts of it run through each
 * other, result: its shape once it is known}.
 */
export function answersOf(grid, best, shape) {
  const answers = best.answers ?? [];
  if (answers.length < 2) return [];
  return answers.map((one, k) => ({
    grid: placedLike(grid, one.grid), error: one.error_fea_mm ?? one.error_mm, byFea: one.error_fea_mm !== null,
    actuators: one.actuators, length: one.actuator_mm, seconds: one.print_seconds,
    within: one.probability?.together ?? null, beaten: !one.on_front,
    collides: (one.collisions ?? []).length > 0, result: k === 0 ? shape : null,
  }));
}

function differs(a, b) {
  return a.joints.some(([x, y], k) => x !== b.joints[k][0] || y !== b.joints[k][1])
    || a.actuators.some((ratio, k) => ratio !== b.actuators[k]);
}
