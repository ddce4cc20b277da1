// Goals besides points, and surfaces: read strictly, following their parts, moved with the grid.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { readDocument } from "../../../src/simulearn/studio/page/document/document.js";
import {
  moveJoints, mirror, removeParts, rotate, scale, setFixed,
} from "../../../src/simulearn/studio/page/document/edit.js";
import * as goals from "../../../src/simulearn/studio/page/document/goals.js";
import { kindOf } from "../../../src/simulearn/studio/page/document/kinds.js";
import { emptyHistory, record } from "../../../src/simulearn/studio/page/document/history.js";
import { addSurface, keepingSurfaces, withSurface } from "../../../src/simulearn/studio/page/document/surfaces.js";
import { taskFile, taskOf } from "../../../src/simulearn/studio/page/document/task.js";
import { readCopy, writeCopy } from "../../../src/simulearn/studio/page/service/copies.js";
import { cellOf } from "../../../src/simulearn/studio/page/shape/net.js";
import { placedResult } from "../../../src/simulearn/studio/page/shape/placed.js";
import { frozen, near, square } from "./support.mjs";

const MESH = { vertices: [[0, 0, 5], [60, 0, 5], [60, 60, 5], [0, 60, 5]], faces: [[0, 1, 2], [0, 2, 3]] };
const OTHERS = [
  { vertices: [["joint", 1, "centre"], ["joint", 2, "centre"]], distance: 50, weight: 1 },
  { face: ["joint", 2, "top"], direction: [1, 0, 1], weight: 2 },
  { faces: [["beam", 0], ["beam", 2, "end", "top"]], angle: 30, weight: 1 },
  { vertices: "beams", plane: { point: [0, 0, 8], normal: [0, 0, 1] }, weight: 1, slide: false },
  { vertex: ["joint", 3, "centre"], curve: { points: [[0, 0, 0], [10, 0, 0]] }, weight: 1, tolerance: 0.5 },
  { away_from: "itself", clearance: 2, weight: 1 },
];

const onSurface = () => addSurface(frozen(square()), "hood", MESH);
const withOthers = () => ({ ...onSurface(), goals: [...onSurface().goals, ...OTHERS] });
const reread = (document) => readDocument(JSON.parse(JSON.stringify(document)));

test("a surface is a goal of all joints, and goes with its last goal", () => {
  const document = onSurface();
  assert.deepEqual(document.goals, [{ vertices: "joints", surface: "hood", weight: 1 }]);
  assert.equal(document.surfaces[0].vertices, MESH.vertices);
  const two = addSurface(document, "hood", MESH, "free");
  assert.deepEqual(two.surfaces.map(({ name }) => name), ["hood", "hood 2"]);
  assert.equal(two.pose, "free");
  const one = goals.removeGoal(two, 0);
  assert.deepEqual([one.surfaces.map(({ name }) => name), one.pose], [["hood 2"], "free"]);
  const none = goals.removeGoal(one, 0);
  assert.deepEqual([none.goals, none.surfaces, none.pose], [[], [], "fixed"]);
  const full = { ...document, surfaces: Array(4).fill(document.surfaces[0]) };
  assert.equal(addSurface(full, "fifth", MESH), full);
});

test("another grid keeps the goals that any grid can have, unless it has its own", () => {
  const before = { ...withOthers(), pose: "free" };
  const kept = keepingSurfaces(before, square());
  assert.deepEqual([kept.goals, kept.surfaces, kept.pose], [[before.goals[0]], before.surfaces, "free"]);
  const own = square({ goals: [{ vertex: ["joint", 1, "centre"] }] });
  assert.equal(keepingSurfaces(before, own), own);
  const plain = square();
  assert.equal(keepingSurfaces(own, plain), plain);
});

test("what a goal on a surface says can be changed, and nonsense changes nothing", () => {
  const document = onSurface();
  const chosen = goals.setVertices(document, 0, [["joint", 1, "centre"]]);
  assert.deepEqual(chosen.goals[0].vertices, [["joint", 1, "centre"]]);
  const held = goals.setTolerance(goals.setSlide(chosen, 0, false), 0, 0.5);
  assert.deepEqual([held.goals[0].slide, held.goals[0].tolerance], [false, 0.5]);
  const free = goals.setTolerance(goals.setSlide(held, 0, true), 0, null);
  assert.deepEqual(Object.keys(free.goals[0]).sort(), ["surface", "vertices", "weight"]);
  for (const next of [
    goals.setVertices(document, 0, [["joint", 4, "centre"]]), goals.setVertices(document, 0, []),
    goals.setVertices(document, 3, "joints"), goals.setSlide(document, 0, true), goals.setTolerance(document, 0, -1),
    goals.moveGoal(document, 0, [1, 2, 3]), goals.setPose(document, "fixed"),
  ]) assert.equal(next, document);
});

test("a document with every kind of goal is read as it was written", () => {
  const document = withOthers();
  assert.deepEqual(reread(document), document);
});

test("what is no goal or surface is refused with its place", () => {
  const wrong = [
    [(d) => { d.goals[0].surface = "roof"; }, /goals\[0\].surface is "roof"; the document has no such/],
    [(d) => { delete d.goals[0].surface; }, /goals\[0\] wants nothing/],
    [(d) => { d.goals[0].target = [0, 0, 0]; }, /goals\[0\] wants nothing, or several/],
    [(d) => { d.goals[0].vertices = [["joint", 9, "centre"]]; }, /goals\[0\].vertices is/],
    [(d) => { d.goals[1].vertices = undefined; d.goals[1].faces = [["beam", 0]]; }, /with distance it has vertices/],
    [(d) => { d.goals[2].face = ["joint", 2, 4]; }, /goals\[2\].face is/],
    [(d) => { d.goals[4].plane = { point: [0, 0] }; }, /goals\[4\].plane is/],
    [(d) => { d.goals[5].curve = "x"; }, /goals\[5\].curve is "x"/],
    [(d) => { d.goals[5].tolerance = 0; }, /goals\[5\].tolerance is 0/],
    [(d) => { d.goals[6].more = 1; }, /goals\[6\] has the key "more"/],
    [(d) => { d.surfaces[0].faces[1] = [0, 1, 4]; }, /surfaces\[0\].faces are not/],
    [(d) => { d.surfaces[0].vertices[0] = [0, 0, null]; }, /surfaces\[0\].vertices are not/],
    [(d) => { d.surfaces.push(null); }, /surfaces\[1\].name is none/],
    [(d) => { d.pose = "loose"; }, /pose is "loose"/],
  ];
  for (const [break_, message] of wrong) {
    const data = JSON.parse(JSON.stringify(withOthers()));
    break_(data);
    assert.throws(() => readDocument(JSON.parse(JSON.stringify(data))), message);
  }
});

test("goals follow their parts, and go with what they are about", () => {
  const document = withOthers();
  const less = removeParts(document, { joints: [1], beams: [] });
  assert.deepEqual(less.goals.map(kindOf), ["surface", "direction", "plane", "curve", "away_from"]);
  assert.deepEqual(less.goals[1].face, ["joint", 1, "top"]);
  assert.deepEqual(less.goals[3].vertex, ["joint", 2, "centre"]);
  assert.equal(less.surfaces, document.surfaces);
  assert.deepEqual(reread(less), less);
  assert.equal(moveJoints(document, [1], [3, 0]).goals, document.goals);
});

test("surfaces and goals stay in place, or turn, mirror and grow with the grid", () => {
  const document = withOthers();
  assert.deepEqual(setFixed(document, 1).surfaces[0].vertices[1], [0, 0, 5]);
  const turned = rotate(document, "all", 90);
  assert.deepEqual(turned.surfaces[0].vertices[1], [0, 60, 5]);
  assert.deepEqual(turned.goals[2].direction, [0, 1, 1]);
  assert.deepEqual(mirror(document, "all", "x").surfaces[0].vertices[1], [-60, 0, 5]);
  const large = scale(document, 2);
  assert.deepEqual(large.surfaces[0].vertices[2], [120, 120, 10]);
  assert.deepEqual([large.goals[1].distance, large.goals[6].clearance], [100, 4]);
  assert.deepEqual(large.goals[4].plane, { point: [0, 0, 16], normal: [0, 0, 2] });
  assert.deepEqual(rotate(document, { joints: [1], beams: [] }, 90).surfaces, document.surfaces);
});

test("a task has the triangles in place of the surface's name", () => {
  const task = taskOf({ ...onSurface(), pose: "free", materials: ["x"] });
  assert.deepEqual(task.goals, [{ vertices: "joints", surface: MESH, weight: 1 }]);
  assert.deepEqual([task.pose, task.materials], ["free", ["x"]]);
  assert.equal("materials" in taskFile({ ...onSurface(), materials: ["x"] }), false);
  assert.equal("pose" in taskOf(onSurface()), false);
});

beforeEach(() => {
  const items = new Map();
  globalThis.localStorage = {
    getItem: (key) => items.get(key) ?? null, setItem: (key, text) => void items.set(key, text),
    removeItem: (key) => items.delete(key),
  };
});

test("a copy holds the triangles once, however many steps share them", () => {
  const document = onSurface();
  let history = record(emptyHistory(), square(), "surface");
  for (let k = 0; k < 20; k += 1) history = record(history, { ...document, name: `${k}` }, "name");
  writeCopy("a", { revision: 1, saved: false, document, history });
  const text = globalThis.localStorage.getItem("simulearn.design.a");
  assert.equal(text.split(JSON.stringify(MESH.vertices)).length, 2);
  const copy = readCopy("a");
  assert.deepEqual(copy, { revision: 1, saved: false, document, history });
  assert.equal(copy.history.past[3].document.surfaces[0].vertices, copy.document.surfaces[0].vertices);
});

test("another unit gives a surface other triangles and leaves its goals", () => {
  const vertices = MESH.vertices.map((vertex) => vertex.map((x) => 25.4 * x));
  const inches = withSurface(onSurface(), "hood", { ...MESH, vertices });
  near(inches.surfaces[0].vertices[2][0], 1524);
  assert.equal(inches.goals.length, 1);
});

test("a shape is placed where it is compared, and its net has round distances", () => {
  const [joints, beams] = [Float32Array.of(1, 2, 3), Float32Array.of(0, 0, 1)];
  const result = { joints, beams, collisions: [{ place: [1, 0, 0] }], rise_mm: 4 };
  const placed = placedResult(result, { turn: [[0, -1, 0], [1, 0, 0], [0, 0, 1]], shift: [10, 0, 0] });
  assert.deepEqual([...placed.joints], [8, 1, 3]);
  assert.deepEqual([...placed.beams], [10, 0, 1]);
  assert.deepEqual([placed.collisions[0].place, placed.rise_mm], [[10, 1, 0], 4]);
  assert.deepEqual([12, 100, 130, 1400].map(cellOf), [1, 10, 20, 200]);
});
