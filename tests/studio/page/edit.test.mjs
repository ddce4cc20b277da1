// Changes of joints, beams, ratios and the fixed joint.

import assert from "node:assert/strict";
import { test } from "node:test";
import * as edit from "../../../src/simulearn/studio/page/document/edit.js";
import { emptyDocument } from "../../../src/simulearn/studio/page/document/document.js";
import { beamLength } from "../../../src/simulearn/studio/page/document/measure.js";
import { documentOf, edges, frozen, near, square } from "./support.mjs";

const vertices = ({ goals }) => goals.map(({ vertex }) => vertex);

test("moving shares what has not moved", () => {
  const document = frozen(square());
  const next = edit.moveJoints(document, [1, 1, 77], [5, -2.5]);
  assert.deepEqual(next.grid.joints[1], [65, -2.5]);
  assert.equal(next.grid.joints[0], document.grid.joints[0]);
  assert.equal(next.grid.beams, document.grid.beams);
  assert.equal(next.goals, document.goals);
});

test("what changes nothing or is no number gives the same document", () => {
  const document = frozen(square({ actuators: [0.5, 0, 0, 0], goals: [{ vertex: ["joint", 1, "centre"] }] }));
  const nothing = [
    edit.moveJoints(document, [1], [0, 0]),
    edit.moveJoints(document, [], [3, 3]),
    edit.moveJoints(document, [1], [NaN, 0]),
    edit.moveJoints(document, [0, 1], [99_970, 0]), // joint 1 would be too far, so none moves
    edit.placeJoint(document, 1, [60, 0]),
    edit.placeJoint(document, 1, [Infinity, 0]),
    edit.placeJoint(document, 9, [1, 1]),
    edit.removeParts(document, {}),
    edit.removeParts(document, { joints: [9], beams: [-1] }),
    edit.setActuators(document, [0], 0.5),
    edit.setActuators(document, [0], NaN),
    edit.setActuators(document, [9], 1),
    edit.flipActuators(document, [1, 2]),
    edit.stepActuators(edit.setActuators(document, [0], 0.5), [], 1),
    edit.setFixed(document, 0),
    edit.setFixed(document, 4),
    edit.setFixed(document, 0.5),
    edit.rotate(document, "all", 0),
    edit.rotate(document, "all", 360),
    edit.rotate(document, "all", NaN),
    edit.rotate(document, { joints: [2], beams: [] }, 45),
    edit.scale(document, 1),
    edit.scale(document, 0),
    edit.scale(document, 1e9),
    edit.setBeamLength(document, 0, 60),
    edit.setBeamLength(document, 0, NaN),
    edit.setBeamLength(document, 0, -5),
    edit.mergeJoints(document, 1, 1),
    edit.mergeJoints(document, 1, 9),
    edit.pasteParts(document, edit.copyParts(emptyDocument(), "all"), [0, 0]),
    edit.pasteParts(document, { joints: [[NaN, 0]], beams: [], actuators: [] }, [0, 0]),
    edit.pasteParts(document, { joints: [[0, 0]], beams: [[0, 4]], actuators: [0] }, [0, 0]),
    edit.pasteParts(document, null, [0, 0]),
    edit.pasteParts(document, edit.copyParts(document, "all"), [NaN, 0]),
  ];
  nothing.forEach((next, k) => assert.equal(next, document, `change ${k}`));
  const empty = emptyDocument();
  for (const next of [edit.mirror(empty, "all", "x"), edit.rotate(empty, null, 30), edit.scale(empty, 2)])
    assert.equal(next, empty);
});

test("sums of coordinates have no rounding to show", () => {
  let document = documentOf([[0.1, 0]], []);
  document = edit.moveJoints(document, [0], [0.2, 0]);
  assert.deepEqual(document.grid.joints, [[0.3, 0]]);
});

test("removing a joint takes its beams, and joints that lose their last beam", () => {
  const document = documentOf(
    [[0, 0], [60, 0], [60, 60], [0, 60], [120, 0]], [[0, 1], [1, 2], [2, 3], [3, 0], [1, 4]],
    { actuators: [0.1, 0.2, 0.3, 0.4, 0.5] },
  );
  const next = edit.removeParts(frozen(document), { joints: [1] });
  assert.deepEqual(next.grid.joints, [[0, 0], [60, 60], [0, 60]]);
  assert.deepEqual(next.grid.beams, [[1, 2], [2, 0]]);
  assert.deepEqual(next.grid.actuators, [0.3, 0.4]);
  const unused = documentOf([[0, 0], [60, 0], [9, 9]], [[0, 1]]);
  assert.deepEqual(edit.removeParts(unused, { beams: [0] }).grid.joints, [[9, 9]]); // had no beam before
});

test("goals and the fixed joint follow a removal; targets stay where they are in the plan", () => {
  const goals = [
    { vertex: ["joint", 0, 5], target: [1, 2, 3] }, { vertex: ["joint", 2, "centre"], target: [60, 60, 9] },
    { vertex: ["beam", 2, "end", 1], target: [0, 60, 4] }, { vertex: ["beam", 0, "middle", "centre"] },
  ];
  const document = frozen(square({ goals }));
  const next = edit.removeParts(document, { joints: [0] });
  assert.equal(next.grid.fixed, 0); // joint 1 before: the nearest, first of two
  assert.deepEqual(vertices(next), [["joint", 1, "centre"], ["beam", 1, "end", 1]]);
  assert.deepEqual(next.goals.map(({ target }) => target), [[0, 60, 9], [-60, 60, 4]]);
  const gone = edit.removeParts(document, { joints: [0, 1, 2, 3] });
  assert.deepEqual(gone.grid, { ...document.grid, joints: [], beams: [], actuators: [], fixed: 0 });
  assert.deepEqual(gone.goals, []);
});

test("a joint that bears something is fixed rather than a nearer one that dangles", () => {
  const joints = [[0, 0], [10, 0], [-50, 0], [60, 0], [60, 60], [120, 0]];
  const document = documentOf(joints, [[0, 1], [1, 2], [0, 3], [3, 4], [4, 5], [5, 3]]);
  assert.deepEqual(edit.removeParts(document, { joints: [0] }).grid.joints[edit.removeParts(
    document, { joints: [0] }).grid.fixed], [60, 0]);
});

test("merging joints joins their beams, drops second ones and keeps the first's place", () => {
  const document = square({ fixed: 3, actuators: [0.1, 0.2, 0.3, 0.4], goals: [
    { vertex: ["joint", 3, "centre"] },
    { vertex: ["joint", 1, "centre"] },
    { vertex: ["beam", 3, "start", 0] },
  ] });
  const next = edit.mergeJoints(document, 1, 3);
  assert.deepEqual(next.grid.joints, [[0, 0], [60, 0], [60, 60]]);
  assert.deepEqual(next.grid.beams, [[0, 1], [1, 2]]);
  assert.deepEqual(next.grid.actuators, [0.1, 0.2]);
  assert.equal(next.grid.fixed, 1);
  // The goal of joint 1 is the second at that vertex; beam 3 ran the other way.
  assert.deepEqual(vertices(next), [["joint", 1, "centre"], ["beam", 0, "end", 1]]);
  const before = edit.mergeJoints(document, 3, 0);
  assert.deepEqual(before.grid.joints, [[60, 0], [60, 60], [0, 60]]);
});

test("ratios are set, stepped in quarters and flipped within -1 to 1", () => {
  const document = square({ actuators: [0, 0.3, -1, 1] });
  assert.deepEqual(edit.setActuators(document, [0, 1], 7).grid.actuators, [1, 1, -1, 1]);
  assert.deepEqual(edit.stepActuators(document, [0, 1, 2, 3], 1).grid.actuators, [0.25, 0.5, -0.75, 1]);
  assert.deepEqual(edit.stepActuators(document, [0, 1, 2, 3], -1).grid.actuators, [-0.25, 0.25, -1, 0.75]);
  assert.deepEqual(edit.flipActuators(document, [0, 1, 2]).grid.actuators, [0, -0.3, 1, 1]);
  const third = edit.setActuators(document, [0], 0.1 + 0.15);
  assert.equal(edit.stepActuators(third, [0], -1).grid.actuators[0], 0);
});

test("fixing another joint keeps the places of targets in the plan", () => {
  const document = square({ goals: [{ vertex: ["joint", 3, "centre"], target: [0, 60, 8] }] });
  const next = edit.setFixed(document, 2);
  assert.equal(next.grid.fixed, 2);
  assert.deepEqual(next.goals[0].target, [-60, 0, 8]);
  assert.deepEqual(edit.setFixed(next, 0), document);
});

test("a mirror image keeps ratios; twice is the beginning", () => {
  const document = documentOf([[0, 0], [60, 0], [70, 40], [0, 30]], [[0, 1], [1, 2], [2, 3], [3, 0]], {
    actuators: [0.5, -0.5, 1, 0],
    goals: [
      { vertex: ["joint", 1, 2], target: [10, 20, 30] },
      { vertex: ["beam", 1, "end", 3], target: [1, 2, 3] },
    ],
  });
  for (const axis of ["x", "y"]) {
    const next = edit.mirror(document, null, axis);
    assert.deepEqual(next.grid.actuators, document.grid.actuators);
    assert.deepEqual(next.grid.joints[0], [0, 0]); // the fixed joint stays
    assert.deepEqual(next.goals[1].vertex, ["beam", 1, "end", 2]);
    assert.deepEqual(edit.mirror(next, "all", axis), document);
  }
  assert.deepEqual(edit.mirror(document, "all", "x").grid.joints[2], [-70, 40]);
  assert.deepEqual(edit.mirror(document, "all", "x").goals[0].target, [-10, 20, 30]);
  const part = edit.mirror(document, { joints: [], beams: [1] }, "x"); // about the middle of 60 and 70
  assert.deepEqual(part.grid.joints, [[0, 0], [70, 0], [60, 40], [0, 30]]);
  assert.deepEqual(part.goals[0].target, [10, 20, 30]);
});

test("turning goes about the fixed joint, the middle of a selection, or a given point", () => {
  const document = square({ fixed: 1, goals: [{ vertex: ["joint", 0, "centre"], target: [-60, 0, 7] }] });
  const quarter = edit.rotate(document, "all", 90);
  assert.deepEqual(quarter.grid.joints, [[60, -60], [60, 0], [0, 0], [0, -60]]);
  assert.deepEqual(quarter.goals[0].target, [0, -60, 7]);
  const side = edit.rotate(document, { joints: [2, 3], beams: [] }, 180);
  assert.deepEqual(side.grid.joints, [[0, 0], [60, 0], [0, 60], [60, 60]]);
  assert.equal(side.goals, side.goals);
  assert.deepEqual(side.goals[0].target, [-60, 0, 7]);
  assert.deepEqual(edit.rotate(document, null, -90, [0, 0]).grid.joints[1], [0, -60]);
  const twelve = Array.from({ length: 12 }).reduce((one) => edit.rotate(one, "all", 30), document);
  twelve.grid.joints.flat().forEach((x, n) => near(x, document.grid.joints.flat()[n], 1e-5));
});

test("a length is exact, and the end that is freer moves, never the fixed joint", () => {
  const joints = [[0, 0], [60, 0], [60, 60], [0, 60], [90, 40]];
  const document = documentOf(joints, [[0, 1], [1, 2], [2, 3], [3, 0], [1, 4]]);
  const dangling = edit.setBeamLength(document, 4, 33.3);
  near(beamLength(dangling.grid, 4), 33.3);
  assert.deepEqual(dangling.grid.joints.slice(0, 4), joints.slice(0, 4));
  const atFixed = edit.setBeamLength(edit.setFixed(document, 4), 4, 70);
  assert.deepEqual(atFixed.grid.joints[4], [90, 40]);
  near(beamLength(atFixed.grid, 4), 70);
  assert.deepEqual(edit.setBeamLength(document, 2, 50).grid.joints[2], [50, 60]); // 2 is farther than 3
  const point = documentOf([[5, 5], [5, 5]], [[0, 1]]);
  assert.deepEqual(edit.setBeamLength(point, 0, 20).grid.joints, [[5, 5], [25, 5]]);
});

test("scaling goes about the fixed joint and takes the targets along", () => {
  const document = square({ fixed: 1, goals: [{ vertex: ["joint", 0, "centre"], target: [-60, 0, 7] }] });
  const next = edit.scale(document, 1.5);
  assert.deepEqual(next.grid.joints, [[-30, 0], [60, 0], [60, 90], [-30, 90]]);
  assert.deepEqual(next.goals[0].target, [-90, 0, 10.5]);
});

test("copies have the beams of the selection and their ratios, and come last", () => {
  const document = square({ actuators: [0.1, 0.2, 0.3, 0.4] });
  const clip = edit.copyParts(document, { joints: [0, 1, 2], beams: [2] });
  assert.equal(clip.joints.length, 4);
  assert.deepEqual(clip.beams, [[0, 1], [1, 2], [2, 3]]);
  const next = edit.pasteParts(frozen(document), clip, [130, 30]);
  assert.deepEqual(next.grid.joints.slice(4), [[100, 0], [160, 0], [160, 60], [100, 60]]);
  assert.deepEqual(next.grid.beams.slice(4), [[4, 5], [5, 6], [6, 7]]);
  assert.deepEqual(next.grid.actuators.slice(4), [0.1, 0.2, 0.3]);
  const all = edit.pasteParts(emptyDocument(), edit.copyParts(document, "all"), [30, 30]);
  assert.deepEqual(edges(all.grid), edges(document.grid));
});
