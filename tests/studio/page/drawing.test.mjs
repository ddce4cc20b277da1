// Lines that are drawn become joints and beams.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  addJointOnBeam, addPolyline, settle, splitBeam,
} from "../../../src/simulearn/studio/page/document/drawing.js";
import { moveJoints, placeJoint } from "../../../src/simulearn/studio/page/document/edit.js";
import { emptyDocument } from "../../../src/simulearn/studio/page/document/document.js";
import { assertWellFormed, documentOf, edges, frozen, square } from "./support.mjs";

const counts = ({ grid }) => [grid.joints.length, grid.beams.length];

test("a polyline gives its corners and beams in order, without actuators", () => {
  const { grid } = addPolyline(frozen(emptyDocument()), [[0, 0], [60, 0], [60, 60]]);
  assert.deepEqual(grid.joints, [[0, 0], [60, 0], [60, 60]]);
  assert.deepEqual(grid.beams, [[0, 1], [1, 2]]);
  assert.deepEqual(grid.actuators, [0, 0]);
});

test("a closed polyline closes, and one that crosses itself gets a joint there", () => {
  const eight = addPolyline(emptyDocument(), [[0, 0], [60, 60], [60, 0], [0, 60], [0, 0]]);
  assert.deepEqual(counts(eight), [5, 6]);
  assert.ok(eight.grid.joints.some(([x, y]) => x === 30 && y === 30));
});

test("what is no line changes nothing", () => {
  const document = square();
  const nowhere = [
    [], [[5, 5]], [[5, 5], [5, 5]], [[5, 5], [5.4, 5.4]], [[NaN, 0], [Infinity, 1]], [[1e6, 0], [0, 1e6]],
  ];
  for (const points of nowhere) assert.equal(addPolyline(document, points), document);
});

test("points that are none are passed over", () => {
  const { grid } = addPolyline(emptyDocument(), [[0, 0], [NaN, 3], [60, 0], ["a", "b"], null, [60, 0]]);
  assert.deepEqual(grid.joints, [[0, 0], [60, 0]]);
});

test("a crossing splits both lines, and the parts of the old beam keep its ratio", () => {
  const document = documentOf([[0, 0], [60, 0]], [[0, 1]], { actuators: [-0.75] });
  const { grid } = addPolyline(frozen(document), [[30, -30], [30, 30]]);
  assert.deepEqual(edges(grid), edges({
    joints: [[0, 0], [30, 0], [60, 0], [30, -30], [30, 30]], beams: [[0, 1], [1, 2], [3, 1], [1, 4]],
  }));
  assert.deepEqual(grid.actuators, [-0.75, 0, -0.75, 0]);
});

test("beams keep their numbers, new parts come last", () => {
  const document = square({ actuators: [0.25, 0.5, 0.75, 1] });
  const { grid } = addPolyline(document, [[30, -20], [30, 80]]);
  assert.deepEqual(grid.beams.slice(0, 4).map(([i]) => i), [0, 1, 2, 3]);
  assert.deepEqual(grid.actuators.slice(0, 4), [0.25, 0.5, 0.75, 1]);
});

test("a crossing at a joint uses that joint", () => {
  const cross = documentOf([[0, 0], [30, 0], [60, 0]], [[0, 1], [1, 2]]);
  for (const off of [0, 0.6]) {
    const next = addPolyline(cross, [[30 + off, -30], [30 + off, 30]]);
    assert.deepEqual(counts(next), [5, 4]);
  }
});

test("a crossing near the joint of one line, not on it, splits the other there", () => {
  // Joint 2 lies 0.5 mm off beam 0, without being joined to it; the line goes through it.
  const document = documentOf([[0, 0], [60, 0], [30, 0.5], [30, 40]], [[0, 1], [2, 3]]);
  const { grid } = addPolyline(document, [[10, -30], [30, 0.5]]);
  assert.ok(grid.beams.every(([i, j]) => !(i === 0 && j === 1)));
  assert.equal(grid.joints.length, 5);
});

test("an end on a beam splits the beam, a joint on a line splits the line", () => {
  const onto = addPolyline(square(), [[30, 90], [30, 60.5]]);
  assert.deepEqual(counts(onto), [6, 6]);
  assert.ok(onto.grid.joints.some(([x, y]) => x === 30 && y === 60)); // the beam stays straight
  const through = addPolyline(square(), [[-40, 0.4], [100, 0.4]]);
  assert.deepEqual(counts(through), [6, 6]); // over the beam 0 - 1, which is there once
});

test("a line over beams gives beams between consecutive joints, once", () => {
  const row = documentOf([[0, 0], [30, 0], [60, 0]], [[0, 1], [1, 2]], { actuators: [0.5, -0.5] });
  assert.equal(addPolyline(row, [[0, 0], [60, 0]]), row);
  assert.equal(addPolyline(row, [[60, 0.3], [0, -0.3]]), row);
  const longer = addPolyline(row, [[-20, 0], [45, 0]]);
  assert.deepEqual(counts(longer), [5, 4]);
  assert.deepEqual(longer.grid.actuators, [0.5, -0.5, 0, -0.5]);
  const aslant = addPolyline(row, [[-20, -0.4], [80, 0.4]]); // nearly along the beams, and over
  assert.deepEqual(counts(aslant), [5, 4]);
});

test("lines drawn back and forth give their beams once", () => {
  const once = addPolyline(emptyDocument(), [[0, 0], [60, 0], [0, 0], [30, 0], [60, 0]]);
  assert.deepEqual(counts(once), [3, 2]);
});

test("a fine polyline within the tolerance of itself stays well-formed", () => {
  const turns = Array.from({ length: 200 }, (_, k) => k / 9);
  const spiral = turns.map((angle) => [0.18 * angle * Math.cos(angle), 0.18 * angle * Math.sin(angle)]);
  assertWellFormed(addPolyline(emptyDocument(), spiral));
});

test("splitting keeps ratio, numbers and what is not touched", () => {
  const document = frozen(square({ actuators: [0.3, 0, 0, 0] }));
  const next = splitBeam(document, 0, 0.25);
  assert.deepEqual(next.grid.joints[4], [15, 0]);
  assert.deepEqual([next.grid.beams[0], next.grid.beams[4]], [[0, 4], [4, 1]]);
  assert.deepEqual([next.grid.actuators[0], next.grid.actuators[4]], [0.3, 0.3]);
  assert.equal(next.grid.beams[1], document.grid.beams[1]);
  assert.equal(next.grid.joints[0], document.grid.joints[0]);
  for (const t of [0, 1, -1, NaN]) assert.equal(splitBeam(document, 0, t), document);
  assert.equal(splitBeam(document, 9), document);
  assert.deepEqual(addJointOnBeam(document, 1, [70, 20]).grid.joints[4], [60, 20]);
  assert.equal(addJointOnBeam(document, 1, [70, -20]), document); // its end
});

test("goals on a split beam stay where they were", () => {
  const vertices = [
    ["beam", 0, "start", 1], ["beam", 0, "middle", "centre"], ["beam", 0, "end", "centre"],
    ["beam", 0, "middle", 2], ["beam", 1, "middle", "centre"],
  ];
  const document = square({ goals: vertices.map((vertex) => ({ vertex })) });
  assert.deepEqual(splitBeam(document, 0).goals.map(({ vertex }) => vertex), [
    ["beam", 0, "start", 1], ["joint", 4, "centre"], ["beam", 4, "end", "centre"],
    ["beam", 0, "end", 2], ["beam", 1, "middle", "centre"],
  ]);
  const third = splitBeam(document, 0, 0.9).goals.map(({ vertex }) => vertex);
  assert.deepEqual(third[1], ["beam", 0, "middle", "centre"]); // 0.45, nearer than the joint at 0.9
});

test("goals on a part that a beam in the other sense replaces change ends and sides", () => {
  // Beam 1 runs back over beam 0's second half.
  const goals = [{ vertex: ["beam", 0, "end", 0] }, { vertex: ["beam", 1, "start", 0] }];
  const document = documentOf([[0, 0], [60, 0], [30, 0]], [[0, 1], [1, 2]], { goals });
  const next = settle(document, [2]);
  assert.deepEqual(next.grid.beams, [[0, 2], [1, 2]]);
  const vertices = next.goals.map(({ vertex }) => vertex);
  assert.deepEqual(vertices, [["beam", 1, "start", 1], ["beam", 1, "start", 0]]);
});

test("a joint that is dropped on another becomes that one", () => {
  const goals = [{ vertex: ["joint", 3, "centre"] }, { vertex: ["joint", 2, "centre"] }];
  const document = frozen(square({ fixed: 2, goals }));
  const next = settle(moveJoints(document, [2], [0.4, -59.5]), [2]);
  assert.deepEqual(next.grid.joints, [[0, 0], [60, 0], [0, 60]]);
  assert.deepEqual(next.grid.beams, [[0, 1], [1, 2], [2, 0]]);
  assert.equal(next.grid.fixed, 1);
  assert.deepEqual(next.goals.map(({ vertex }) => vertex), [["joint", 2, "centre"], ["joint", 1, "centre"]]);
});

test("a joint that is dropped on a beam splits it, a beam that is dragged over a joint is split", () => {
  const goals = [[0, 0], [60, 0], [60, 60], [0, 60], [30, 100]];
  const document = documentOf(goals, [[0, 1], [1, 2], [2, 3], [3, 0], [3, 4], [4, 2]]);
  const dropped = settle(placeJoint(document, 4, [30, 0.5]), [4]);
  assert.ok(!edges(dropped.grid).includes("0,0 - 60,0"));
  assert.deepEqual(dropped.grid.joints[4], [30, 0.5]); // where it was put
  const bar = documentOf([[0, 0], [60, 0], [30, -20], [30, 5], [30, 40]], [[0, 1], [3, 4], [2, 3]]);
  const over = settle(moveJoints(bar, [0, 1], [0, 5]), [0, 1]);
  assert.deepEqual(counts(over), [5, 4]);
});

test("beams that cross after a drag get a joint", () => {
  const joints = [[0, 0], [60, 0], [30, 10], [30, 50]];
  const document = documentOf(joints, [[0, 1], [2, 3]], { actuators: [1, -1] });
  assert.equal(settle(document, [2]), document);
  const next = settle(moveJoints(document, [2], [0, -30]), [2]);
  assert.deepEqual(counts(next), [5, 4]);
  assert.deepEqual(next.grid.actuators, [1, -1, 1, -1]);
});

test("nothing that has not moved is joined", () => {
  const joints = [[0, 0], [60, 0], [30, -30], [30, 30], [200, 0], [260, 0]];
  const crossing = documentOf(joints, [[0, 1], [2, 3], [4, 5]]);
  assert.equal(settle(crossing, [4]), crossing);
  assert.equal(settle(crossing, []), crossing);
  assert.equal(settle(crossing, [99]), crossing);
  assert.equal(settle(emptyDocument(), [0]).grid.joints.length, 0);
});
