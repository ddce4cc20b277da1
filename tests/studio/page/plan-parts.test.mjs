// What the plan finds, measures and says about parts; keys; the line being drawn.

import assert from "node:assert/strict";
import { test } from "node:test";

const PLAN = "../../../src/simulearn/studio/page/plan";
const { isSelected, partAt, partsInBox, toggled } = await import(`${PLAN}/hit.js`);
const { neighbour, placeOf, tabStop } = await import(`${PLAN}/focus.js`);
const { commonRatio, jointHeight, netLengths, shown } = await import(`${PLAN}/lengths.js`);
const { marksOf, partsIn } = await import(`${PLAN}/messages.js`);
const { command, isElsewhere, nudgeStep } = await import(`${PLAN}/keys.js`);
const line = await import(`${PLAN}/tools/polyline.js`);

const GRID = {
  joints: [[0, 0], [60, 0], [60, 60], [0, 60]],
  beams: [[0, 1], [1, 2], [2, 3], [3, 0]],
  actuators: [0.5, -0.5, 0, 0.5], fixed: 0,
};

test("joints win over beams, beams are hit over their width", () => {
  assert.deepEqual(partAt(GRID, [58, 1], 3, 7.2), { joint: 1 });
  assert.deepEqual(partAt(GRID, [30, 3.5], 3, 7.2), { beam: 0 });
  assert.equal(partAt(GRID, [30, 3.7], 3, 7.2), null);
  assert.equal(partAt({ joints: [], beams: [] }, [0, 0], 3, 7.2), null);
});

test("a box holds beams only with both ends, in whichever direction it was drawn", () => {
  assert.deepEqual(partsInBox(GRID, [[70, 10], [-5, -5]]), { joints: [0, 1], beams: [0] });
  assert.deepEqual(partsInBox(GRID, [[20, -5], [70, 10]]), { joints: [1], beams: [] });
});

test("toggling twice changes nothing", () => {
  const selection = { joints: [1], beams: [2] };
  assert.deepEqual(toggled(toggled(selection, { beam: 0 }), { beam: 0 }), selection);
  assert.equal(isSelected(toggled(selection, { joint: 1 }), { joint: 1 }), false);
});

test("arrows lead along the grid: joint, beam, joint, and stay at its end", () => {
  assert.deepEqual(neighbour(GRID, { joint: 0 }, "ArrowRight"), { beam: 0 });
  assert.deepEqual(neighbour(GRID, { beam: 0 }, "ArrowRight"), { joint: 1 });
  assert.deepEqual(neighbour(GRID, { joint: 1 }, "ArrowUp"), { beam: 1 });
  assert.deepEqual(neighbour(GRID, { joint: 1 }, "ArrowRight"), { joint: 1 });
});

test("there is one tab stop; a part that is gone loses it", () => {
  assert.deepEqual(tabStop(GRID, { beam: 3 }), { beam: 3 });
  assert.deepEqual(tabStop(GRID, { joint: 9 }), { joint: 0 });
  assert.equal(tabStop({ joints: [], beams: [] }, null), null);
  assert.deepEqual(placeOf(GRID, { beam: 1 }), [60, 30]);
});

test("net lengths follow a moved joint, and are estimated for another grid", () => {
  const check = { document: { grid: GRID }, netLengths: { 0: 53, 1: 53, 2: 53, 3: 53 } };
  const moved = { ...GRID, joints: [[0, 0], [70, 0], [60, 60], [0, 60]] };
  assert.equal(netLengths(moved, check, 7.2)[0], 63);
  const other = { ...GRID, beams: [[1, 0]], actuators: [0] };
  assert.equal(netLengths(other, check, 7.2)[0], 52.8);
  assert.equal(netLengths(GRID, null, 7.2)[0], 52.8);
});

test("heights are those of the last frame, of this grid alone", () => {
  const joints = new Float32Array(12 * 2 * 24);
  for (let corner = 0; corner < 8; corner += 1) joints[(11 * 2 + 1) * 24 + corner * 3 + 2] = corner;
  const answer = { document: { grid: GRID }, result: { joints, jointCount: 2, joint_numbers: [0, 3] } };
  assert.equal(jointHeight(answer, GRID, 3), 3.5);
  assert.equal(jointHeight(answer, GRID, 1), null);
  assert.equal(jointHeight(answer, { ...GRID }, 3), null);
});

test("numbers are short and never -0", () => {
  assert.equal(shown(-0.01), "0.0");
  assert.equal(shown(-12.34), "-12.3");
  assert.equal(commonRatio(GRID, [0, 3]), 0.5);
  assert.equal(commonRatio(GRID, [0, 1]), null);
});

test("messages mark the parts that they name", () => {
  assert.deepEqual(partsIn("joint 3 and beam 12 overlap"), [["joint", 3], ["beam", 12]]);
  const check = {
    document: { grid: GRID },
    errors: [
      { code: "overlap", where: "beam 2", message: "beam 1 and beam 2 overlap" },
      { code: "actuator-short", where: "beam 1", message: "the actuator of beam 1 is 2 mm long" },
      { code: "disconnected", where: "grid", message: "no beam leads to joints 5" },
    ],
    warnings: [{ code: "beam-short", where: "beam 1", message: "beam 1 is short" }],
  };
  const marks = marksOf(check, GRID);
  assert.deepEqual([...marks.beams.keys()].sort(), [1, 2]);
  assert.equal(marks.beams.get(1).kind, "error");
  assert.equal(marks.beams.get(1).messages.length, 3);
  assert.equal(marks.joints.size, 0);
  assert.equal(marksOf(check, { ...GRID, beams: GRID.beams.slice(1) }).beams.size, 0);
});

test("keys stand for commands", () => {
  const key = (name, more = {}) => command({ key: name, ...more });
  assert.equal(key("D"), "draw");
  assert.equal(key("3"), "quarters 3");
  assert.equal(key("+", { shiftKey: true }), "longer");
  assert.equal(key("d", { ctrlKey: true }), "duplicate");
  assert.equal(key("Z", { metaKey: true, shiftKey: true }), "redo");
  assert.equal(key("ArrowUp", { ctrlKey: true }), "focus");
  assert.equal(key("M", { shiftKey: true }), "mirror y");
  assert.equal(key("d", { altKey: true }), null);
  assert.equal(key("q"), null);
  assert.deepEqual([{}, { shiftKey: true }, { altKey: true }].map(nudgeStep), [1, 10, 0.1]);
});

test("keys in fields and elsewhere on the page are not the plan's", () => {
  globalThis.document = { body: {}, documentElement: {} };
  const plan = { contains: (target) => target.inside === true };
  assert.equal(isElsewhere(globalThis.document.body, plan), false);
  assert.equal(isElsewhere({ inside: true, closest: () => null }, plan), false);
  assert.equal(isElsewhere({ inside: true, closest: () => ({}) }, plan), true);
  assert.equal(isElsewhere({ inside: false, closest: () => null }, plan), true);
});

const typed = (from, text) => [...text].reduce((state, character) => line.type(state, character), from);

test("a typed length and angle place the next corner", () => {
  let state = line.place(line.emptyLine(), [10, 10]).line;
  state = typed(state, "42,5");
  const [x, y] = line.target(state, [10, 90]);
  assert.ok(Math.abs(x - 10) < 1e-9 && Math.abs(y - 52.5) < 1e-9);
  state = typed(line.toggleField(state), "-90");
  assert.ok(Math.abs(line.target(state, [10, 90])[1] + 32.5) < 1e-9);
  assert.equal(line.isTyping(line.place(state, [10, -32.5]).line), false);
});

test("what is no number is not typed, nor before the first corner", () => {
  const state = line.place(line.emptyLine(), [0, 0]).line;
  assert.equal(line.type(state, "d"), null);
  assert.equal(line.type(state, "-"), null);
  assert.equal(line.type(typed(state, "4."), "."), null);
  assert.equal(line.type(line.emptyLine(), "4"), null);
  assert.equal(line.typed("-"), null);
});

test("backspace takes back what was typed, then corners", () => {
  let state = line.place(line.place(line.emptyLine(), [0, 0]).line, [50, 0]).line;
  state = typed(line.toggleField(typed(state, "7")), "9");
  state = line.backspace(state);
  assert.equal(state.angle, "");
  state = line.backspace(line.backspace(state));
  assert.equal(state.length, "");
  assert.deepEqual(line.backspace(state).points, [[0, 0]]);
});

test("the last corner once more ends the line, the first one closes it", () => {
  let placed = line.place(line.emptyLine(), [0, 0]);
  assert.equal(line.place(placed.line, [0, 0]).ended, false);
  placed = line.place(placed.line, [50, 0]);
  assert.equal(line.place(placed.line, [50, 0]).ended, true);
  assert.deepEqual(line.place(placed.line, [50, 0]).line.points.length, 2);
  placed = line.place(placed.line, [50, 50]);
  assert.equal(placed.ended, false);
  assert.equal(line.place(placed.line, [0, 0]).ended, true);
  assert.equal(line.place(placed.line, [0, 0]).line.points.length, 4);
});
