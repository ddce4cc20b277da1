// Documents are read as they are written, and what is none is refused in a sentence.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  emptyDocument, readDocument, sameGrid, withGrid,
} from "../../../src/simulearn/studio/page/document/document.js";
import {
  emptyHistory, record, redoLabel, redone, undoLabel, undone,
} from "../../../src/simulearn/studio/page/document/history.js";
import { hasVertex } from "../../../src/simulearn/studio/page/document/vertices.js";
import { taskOf } from "../../../src/simulearn/studio/page/document/task.js";
import { assertWellFormed, documentOf, square } from "./support.mjs";

const copy = (value) => JSON.parse(JSON.stringify(value));

test("documents are read as they were written", () => {
  assertWellFormed(emptyDocument());
  const goals = [{ vertex: ["beam", 2, "middle", 3], weight: 0 }];
  assertWellFormed({ ...square({ goals }), name: "Größe 🦀" });
});

test("what may be left out has its usual value, and numbered sections get their names", () => {
  const { schema, grid } = square();
  const goals = [{ vertex: ["beam", 1, 2, "centre"], target: [1, 2, 3] }];
  const document = readDocument({ schema, grid, goals });
  assert.deepEqual(document.goals[0], { vertex: ["beam", 1, "end", "centre"], target: [1, 2, 3], weight: 1 });
  assert.equal(document.name, "");
  assert.equal(document.printer, emptyDocument().printer);
  const printer = { profile: 'base = "voron"\n' };
  assert.deepEqual(readDocument({ ...document, printer }).printer, printer);
  assert.deepEqual(document.materials, []);
  const materials = ['name = "my-pla"\n'];
  assert.deepEqual(readDocument({ ...document, materials }).materials, materials);
});

const deep = JSON.parse("[".repeat(50_000) + "]".repeat(50_000));
const WRONG = [
  [() => null, /^the document is null; it is an object with schema, name/],
  [() => [], /the document is \[\]/],
  [(one) => ({ ...one, schema: "simulearn/2" }), /schema is "simulearn\/2"; this page reads/],
  [(one) => ({ ...one, colour: 1 }), /the document has the key "colour"; its keys are/],
  [(one) => JSON.parse(`{"__proto__": 1, ${JSON.stringify(one).slice(1)}`), /has the key "__proto__"/],
  [(one) => ({ ...one, name: 5 }), /name is 5/],
  [(one) => ({ ...one, printer: "" }), /printer is ""/],
  [(one) => ({ ...one, printer: { path: "x.toml" } }), /printer has the key "path"/],
  [(one) => ({ ...one, printer: { profile: "x".repeat(70_000) } }), /printer.profile is "x/],
  [(one) => ({ ...one, materials: {} }), /materials are not a list of at most 16 texts/],
  [(one) => ({ ...one, materials: ["x", { path: "x" }] }), /materials\[1\] is {"path":"x"}; it is a text/],
  [(one) => ({ ...one, materials: Array(17).fill("x") }), /materials are not a list of at most 16/],
  [(one) => ({ ...one, grid: undefined }), /the grid is missing/],
  [(one) => ({ ...one, goals: {} }), /goals are not a list/],
  [(one) => ({ ...one, name: deep }), /name is nested too deeply/],
  [(one, g) => void (g.schema = "simulearn.grid/0"), /grid.schema is/],
  [(one, g) => void (g.joints[1] = [0, null]), /joints\[1\] is \[0,null\]; a joint is \[x, y\] in mm/],
  [(one, g) => void (g.joints[1] = [0, 0, 0]), /joints\[1\]/],
  [(one, g) => void (g.joints[1] = [0, 1e6]), /joints\[1\] lies beyond 100000 mm/],
  [(one, g) => void (g.joints = Array(20_001).fill([0, 0])), /joints has 20001 entries; at most 20000/],
  [(one, g) => void (g.beams[2] = [0, 4]), /beams\[2\] is \[0,4\]; .* two of the joints 0 to 3/],
  [(one, g) => void (g.beams[2] = [0, 1.5]), /beams\[2\]/],
  [(one, g) => void (g.beams[2] = [3, 3]), /beams\[2\] is \[3,3\]; a beam joins two different joints/],
  [(one, g) => void (g.beams[2] = [1, 0]), /beams\[2\] is \[1,0\]; another beam joins the same two joints/],
  [(one, g) => void g.actuators.pop(), /actuators has 3 ratios for 4 beams/],
  [(one, g) => void (g.actuators[1] = 1.01), /actuators\[1\] is 1.01; a ratio lies in \[-1, 1\]/],
  [(one, g) => void (g.actuators[1] = null), /actuators\[1\] is null/],
  [(one, g) => void (g.fixed = 4), /fixed is 4; it is the number of a joint/],
  [(one, g) => void (g.material = 7), /material is 7/],
  [(one) => void (one.goals[0].vertex = ["joint", 4, 0]), /goals\[0\].vertex is \["joint",4,0\]; /],
  [(one) => void (one.goals[0].vertex = "joint"), /goals\[0\].vertex is "joint"/],
  [(one) => void (one.goals[0].target = [1, 2]), /goals\[0\].target is \[1,2\]; a target is/],
  [(one) => void (one.goals[0].weight = -1), /goals\[0\].weight is -1/],
];

test("what is no document is refused in a sentence that names the place", () => {
  for (const [change, words] of WRONG) {
    const one = copy(square({ goals: [{ vertex: ["joint", 1, "centre"] }] }));
    const given = change(one, one.grid);
    const data = given === undefined ? one : given;
    const fits = ({ message }) => words.test(message) && message.length < 300;
    assert.throws(() => readDocument(data), fits, String(words));
  }
});

test("grids are equal when all their numbers are", () => {
  const { grid } = square();
  assert.ok(sameGrid(grid, copy(grid)));
  const changes = [
    { fixed: 1 }, { material: "b" }, { actuators: [0, 0, 0, 1] }, { joints: grid.joints.slice(1) },
    { beams: [[1, 0], ...grid.beams.slice(1)] },
  ];
  for (const change of changes) assert.ok(!sameGrid(grid, { ...grid, ...change }), JSON.stringify(change));
});

test("another grid drops goals whose vertex it does not have", () => {
  const vertices = [["joint", 3, 7], ["joint", 1, "centre"], ["beam", 3, "end", 0]];
  const goals = vertices.map((vertex) => ({ vertex }));
  const document = square({ goals });
  const { grid } = documentOf([[0, 0], [1, 1]], [[0, 1]]);
  assert.deepEqual(withGrid(document, grid).goals, [document.goals[1]]);
  assert.equal(withGrid(document, document.grid), document);
  assert.equal(withGrid(document, copy(document.grid)).goals, document.goals);
  const none = [
    null, [], ["joint"], ["joint", 0, 8], ["joint", 0, "centre", 1], ["beam", 0, "side", 0],
    ["beam", 0, "end", 4],
  ];
  for (const vertex of none)
    assert.ok(!hasVertex(grid, vertex), JSON.stringify(vertex));
});

test("undo and redo give the same objects, and a run of edits with one key is one step", () => {
  const [a, b, c, d] = Array.from({ length: 4 }, emptyDocument);
  let history = record(emptyHistory(), a, "draw");
  history = record(history, b, "move", "drag");
  history = record(history, c, "move", "drag");
  assert.equal(undoLabel(history), "move");
  const one = undone(history, d);
  assert.equal(one.document, b);
  assert.equal(redoLabel(one.history), "move");
  const two = undone(one.history, one.document);
  assert.equal(two.document, a);
  assert.equal(undone(two.history, a), null);
  const again = redone(redone(two.history, a).history, b);
  assert.equal(again.document, d);
  assert.equal(redone(again.history, d), null);
  assert.equal(redoLabel(record(one.history, b, "draw")), null);
});

test("a task has the document's goals and leaves out what is not given", () => {
  const document = square({ goals: [{ vertex: ["joint", 2, "centre"], target: [1, 2, 3], weight: 2 }] });
  assert.deepEqual(taskOf(document), {
    schema: "simulearn.task/1", grid: document.grid, goals: document.goals, engine: "learned",
  });
  const task = taskOf(document, { free: { joints: [] }, limits: { seconds: 5 }, method: "newton" });
  assert.deepEqual([task.free, task.limits, task.method], [{ joints: [] }, { seconds: 5 }, "newton"]);
});
