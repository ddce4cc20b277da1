// Designs that a search or a ranking made: where they lie, what they change, the curve of the errors.

import assert from "node:assert/strict";
import { test } from "node:test";
import { changesOf, placedLike, withDesign } from "../../../src/simulearn/studio/page/service/designs.js";
import { answersOf, bestOf, bestSoFar, roundUp, stagesOf } from "../../../src/simulearn/studio/page/service/steps.js";
import { addGoal } from "../../../src/simulearn/studio/page/document/goals.js";
import { frozen, square } from "./support.mjs";

const shifted = (grid, [dx, dy]) => ({ ...grid, joints: grid.joints.map(([x, y]) => [x + dx, y + dy]) });

test("a design of the server comes back to its place, joints that stayed exactly", () => {
  const { grid } = square({ fixed: 2 });
  const made = shifted(grid, [-60, -60 + 1e-12]);
  const joints = made.joints.map(([x, y], k) => (k === 1 ? [x + 5, y] : [x, y]));
  const back = placedLike(frozen(grid), { ...made, joints });
  assert.deepEqual(back.joints[1], [65, 0]);
  for (const k of [0, 2, 3]) assert.equal(back.joints[k], grid.joints[k]);
  assert.equal(back.material, grid.material);
});

test("a design's changes are the joints that moved and the ratios that differ", () => {
  const { grid } = square();
  const made = { ...grid, joints: [[0, 0], [60, 5], [60, 60], [0, 60]], actuators: [0, 0.25, 0, 0] };
  assert.deepEqual(changesOf(grid, made), {
    joints: [{ k: 1, by: [0, 5] }], actuators: [{ b: 1, from: 0, to: 0.25 }],
  });
  assert.deepEqual(changesOf(grid, grid), { joints: [], actuators: [] });
});

test("taking a design keeps the goals of now, or those it was made for if parts were numbered anew", () => {
  const origin = addGoal(square(), ["joint", 1, "centre"], [1, 2, 3]);
  const now = addGoal(origin, ["joint", 2, "centre"], [4, 5, 6]);
  const made = { ...origin.grid, actuators: [1, 0, 0, 0] };
  assert.equal(withDesign(frozen(now), origin, made).goals, now.goals);
  const grid = { ...now.grid, joints: now.grid.joints.slice(1), beams: [[0, 1]], actuators: [0] };
  const other = { ...now, grid };
  const taken = withDesign(frozen(other), origin, made);
  assert.deepEqual([taken.goals, taken.grid], [origin.goals, made]);
});

const step = (designs, error, { phase = 0, ratio = 0 } = {}) => ({
  designs, error_mm: error, phase, grid: { ...square().grid, actuators: [ratio, 0, 0, 0] },
});

test("the curve goes down in steps, and begins anew at targets that were corrected", () => {
  const phase = 1;
  const steps = [
    step(1, 9), step(10, 5), step(20, 7), step(30, 4), step(40, 6, { phase }), step(50, 6, { phase }),
  ];
  const { points, corrections } = bestSoFar(steps);
  assert.deepEqual(points, [[1, 9], [10, 9], [10, 5], [30, 5], [30, 4], [40, 4], [40, 6], [50, 6]]);
  assert.deepEqual(corrections, [40]);
  assert.deepEqual(bestSoFar([]), { points: [], corrections: [] });
});

test("a curve of many steps has a bounded number of points and keeps its end", () => {
  const steps = Array.from({ length: 5000 }, (_, n) => step(n + 1, 5000 - n));
  const { points } = bestSoFar(steps);
  assert.ok(points.length <= 302);
  assert.deepEqual([points[0], points.at(-1)], [[1, 5000], [5000, 1]]);
});

test("an axis ends at a round number", () => {
  assert.deepEqual([0.25, 1, 1.2, 4.9, 6.1, 99, 0].map(roundUp), [0.3, 1, 2, 6, 8, 100, 1]);
});

test("stages are the different designs in their order; the best is the last", () => {
  const { grid } = square();
  const best = { grid: { ...grid, actuators: [0.5, 0, 0, 0] }, error_mm: 1, designs: 40 };
  const steps = [step(1, 9), step(10, 9), step(20, 5, { ratio: 0.25 }), step(30, 1, { ratio: 0.5 })];
  const stages = stagesOf(grid, steps, best, "shape");
  assert.deepEqual(stages.map(({ grid: { actuators } }) => actuators[0]), [0, 0.25, 0.5]);
  assert.equal(stages.at(-1).result, "shape");
  const many = Array.from({ length: 500 }, (_, n) => step(n, 9, { ratio: n / 1000 }));
  assert.ok(stagesOf(grid, many, best, null).length <= 61);
});

test("steps to other answers are neither on the curve nor among the stages", () => {
  const { grid } = square();
  const steps = [
    step(1, 9), step(2, 5, { ratio: 0.25 }), step(3, 7, { phase: -2, ratio: 0.5 }), step(4, 8, { phase: -2, ratio: 1 }),
  ];
  assert.deepEqual(bestSoFar(steps), { points: [[1, 9], [2, 9], [2, 5], [2, 5]], corrections: [] });
  assert.equal(bestOf(grid, steps).error_mm, 5);
  const best = { ...bestOf(grid, steps), grid: steps[1].grid };
  assert.deepEqual(stagesOf(grid, steps, best, null).map(({ error }) => error), [9, 5]);
});

test("several answers have what is needed to choose one; a single one is no choice", () => {
  const { grid } = square();
  const one = {
    grid, error_mm: 0.4, error_fea_mm: 0.5, actuators: 3, actuator_mm: 90, print_seconds: 3000, on_front: true,
    probability: { together: 0.7 },
  };
  const other = { ...one, error_fea_mm: null, print_seconds: null, on_front: false, probability: undefined, collisions: [{}] };
  const shape = {};
  const [first, second] = answersOf(grid, { answers: [one, other] }, shape);
  assert.deepEqual(first, {
    grid, error: 0.5, byFea: true, actuators: 3, length: 90, seconds: 3000, within: 0.7, beaten: false,
    collides: false, result: shape,
  });
  assert.deepEqual(second, {
    grid, error: 0.4, byFea: false, actuators: 3, length: 90, seconds: null, within: null, beaten: true,
    collides: true, result: null,
  });
  assert.deepEqual(answersOf(grid, { answers: [one] }, shape), []);
  assert.deepEqual(answersOf(grid, {}, shape), []);
});
