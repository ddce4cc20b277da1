// Goals and how far the vertices of a result are from them.

import assert from "node:assert/strict";
import { test } from "node:test";
import * as goals from "../../../src/simulearn/studio/page/document/goals.js";
import { frozen, near, square } from "./support.mjs";

const CENTRE = ["joint", 1, "centre"];

/** A result of two joints and a beam: 1000 frame + 100 part + corner + axis / 10. */
function result(numbers = {}) {
  const array = (parts, corners) => {
    const size = 3 * corners; // numbers of a part
    return Float32Array.from({ length: 12 * parts * size }, (_, k) => {
      const [frame, part] = [Math.floor(k / (parts * size)), Math.floor(k / size) % parts];
      return 1000 * frame + 100 * part + (Math.floor(k / 3) % corners) + (k % 3) / 10;
    });
  };
  return { joints: array(2, 8), beams: array(1, 12), jointCount: 2, beamCount: 1, ...numbers };
}

test("a vertex has one goal; adding another moves it", () => {
  const document = frozen(square());
  const one = goals.addGoal(document, CENTRE, [1, 2, 3]);
  assert.deepEqual(one.goals, [{ vertex: CENTRE, target: [1, 2, 3], weight: 1 }]);
  assert.equal(one.grid, document.grid);
  const two = goals.addGoal(one, [...CENTRE], [4, 5, 6], 2);
  assert.deepEqual(two.goals, [{ vertex: CENTRE, target: [4, 5, 6], weight: 2 }]);
  assert.equal(goals.goalOf(two, CENTRE), 0);
  assert.equal(goals.goalOf(two, ["joint", 1, 0]), null);
  const three = goals.addGoal(two, ["beam", 0, "end", 3], [0, 0, 0]);
  const moved = goals.moveGoal(three, 1, [7, 8, 9]);
  assert.equal(moved.goals[0], three.goals[0]);
  assert.deepEqual(moved.goals[1].target, [7, 8, 9]);
  assert.equal(goals.setWeight(moved, 1, 0).goals[1].weight, 0);
  assert.deepEqual(goals.removeGoal(moved, 0).goals, [moved.goals[1]]);
});

test("what is no goal changes nothing", () => {
  const document = goals.addGoal(square(), CENTRE, [1, 2, 3]);
  for (const next of [
    goals.addGoal(document, ["joint", 4, "centre"], [0, 0, 0]),
    goals.addGoal(document, ["joint", 0, "centre"], [0, NaN, 0]),
    goals.addGoal(document, ["joint", 0, "centre"], [0, 0, 0], -1),
    goals.moveGoal(document, 0, [1, 2, 3]),
    goals.moveGoal(document, 0, [1, 2]),
    goals.moveGoal(document, 5, [1, 2, 4]),
    goals.setWeight(document, 0, NaN),
    goals.setWeight(document, 0, 1),
    goals.removeGoal(document, 3),
  ]) assert.equal(next, document);
});

test("the place of a vertex is that of its corner or the mean of its corners", () => {
  const at = (vertex, frame) => goals.vertexPoint(result(), vertex, frame);
  at(["joint", 1, 6], 2).forEach((x, a) => near(x, 2106 + a / 10, 1e-3));
  at(["joint", 1, "centre"], 2).forEach((x, a) => near(x, 2103.5 + a / 10, 1e-3));
  at(["beam", 0, "start", 1], 0).forEach((x, a) => near(x, 1 + a / 10, 1e-3));
  at(["beam", 0, "middle", 2], 11).forEach((x, a) => near(x, 11006 + a / 10, 1e-3));
  at(["beam", 0, "end", "centre"]).forEach((x, a) => near(x, 11009.5 + a / 10, 1e-2));
  at(["joint", 0, 0], 2.25).forEach((x, a) => near(x, 2250 + a / 10, 1e-3));
  at(["joint", 0, 0], 99).forEach((x, a) => near(x, 11000 + a / 10, 1e-2));
});

test("a result without dangling parts is found by the document's numbers", () => {
  const part = result({ joint_numbers: [0, 5], beam_numbers: [7] });
  near(goals.vertexPoint(part, ["joint", 5, 0], 0)[0], 100);
  near(goals.vertexPoint(part, ["beam", 7, "start", 0], 0)[0], 0);
  assert.equal(goals.vertexPoint(part, ["joint", 1, 0], 0), null);
  assert.equal(goals.vertexPoint(part, ["beam", 0, "start", 0], 0), null);
});

test("errors are distances in the last frame, their mean is weighted", () => {
  const part = result({ joint_numbers: [0, 5], beam_numbers: [7] });
  const all = [
    { vertex: ["joint", 0, 0], target: [11000 + 3, 11000.1 + 4, 11000.2], weight: 1 },
    { vertex: ["joint", 5, 0], target: [11100, 11100.1, 11100.2 - 1], weight: 3 },
    { vertex: ["joint", 1, 0], target: [0, 0, 0], weight: 100 },
  ];
  const { each, mean } = goals.goalErrors(part, all);
  near(each[0], 5, 1e-2);
  near(each[1], 1, 1e-2);
  assert.equal(each[2], null);
  near(mean, 2, 1e-2);
  assert.deepEqual(goals.goalErrors(part, []), { each: [], mean: null });
  assert.equal(goals.goalErrors(part, [{ ...all[0], weight: 0 }]).mean, null);
});
