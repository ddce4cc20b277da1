// What holds for every edit of every document, tried with random ones.

import assert from "node:assert/strict";
import { test } from "node:test";
import * as edit from "../../../src/simulearn/studio/page/document/edit.js";
import * as drawing from "../../../src/simulearn/studio/page/document/drawing.js";
import {
  addGoal, moveGoal, removeGoal, setWeight,
} from "../../../src/simulearn/studio/page/document/goals.js";
import { emptyDocument } from "../../../src/simulearn/studio/page/document/document.js";
import { emptyHistory, record, redone, undone } from "../../../src/simulearn/studio/page/document/history.js";
import { crossing, distance, overlapping } from "../../../src/simulearn/studio/page/document/geometry.js";
import { decode, encode } from "../../../src/simulearn/studio/page/document/link.js";
import { assertWellFormed, frozen, seeded } from "./support.mjs";

const SEEDS = 80;
const STEPS = 40;

/** Return random choices for edits: numbers that may not exist, values that may be none. */
function choices(random) {
  const pick = (list) => list[Math.floor(random() * list.length)];
  const index = (count) => Math.floor(random() * (count + 1.2)) - (random() < 0.05 ? 1 : 0);
  const x = () => {
    if (random() < 0.01) return pick([NaN, Infinity, 1e7, -0, 0]);
    return random() < 0.5 ? Math.round(random() * 12) * 10 : random() * 120;
  };
  const point = () => [x(), x()];
  const line = () => Array.from({ length: 1 + random() * 5 }, point);
  const some = (count) => Array.from({ length: Math.floor(random() * 4) }, () => index(count));
  return { pick, index, x, point, line, some };
}

/** The edits by name, each (document, choices, random) -> document. */
const EDITS = {
  polyline: (d, c) => drawing.addPolyline(d, c.line()),
  polyline2: (d, c, r) => drawing.addPolyline(d, c.line(), { tolerance: r() * 8 }),
  drag: (d, c) => {
    const joints = c.some(d.grid.joints.length);
    return drawing.settle(edit.moveJoints(d, joints, [c.x() - 60, c.x() - 60]), joints);
  },
  move: (d, c) => edit.moveJoints(d, c.some(d.grid.joints.length), [c.x() - 60, c.x() - 60]),
  place: (d, c) => edit.placeJoint(d, c.index(d.grid.joints.length), c.point()),
  remove: (d, c) => {
    const { joints, beams } = selection(d, c);
    return edit.removeParts(d, { joints: joints.slice(2), beams: beams.slice(1) });
  },
  set: (d, c, r) => edit.setActuators(d, c.some(d.grid.beams.length), c.pick([r() * 3 - 1.5, NaN, 0, -1])),
  step: (d, c) => edit.stepActuators(d, c.some(d.grid.beams.length), c.pick([1, -1])),
  flip: (d, c) => edit.flipActuators(d, [...d.grid.beams.keys()]),
  fix: (d, c) => edit.setFixed(d, c.index(d.grid.joints.length)),
  mirror: (d, c) => edit.mirror(d, c.pick(["all", null, selection(d, c)]), c.pick(["x", "y"])),
  rotate: (d, c, r) => {
    const degrees = c.pick([90, 45, -180, r() * 400, NaN]);
    return edit.rotate(d, c.pick(["all", null, selection(d, c)]), degrees, c.pick([null, c.point()]));
  },
  length: (d, c) => edit.setBeamLength(d, c.index(d.grid.beams.length), c.x()),
  merge: (d, c) => edit.mergeJoints(d, c.index(d.grid.joints.length), c.index(d.grid.joints.length)),
  scale: (d, c, r) => edit.scale(d, c.pick([0.5 + r(), 0, NaN, -1, 1e9])),
  paste: (d, c) => {
    const next = edit.pasteParts(d, edit.copyParts(d, selection(d, c)), c.point());
    return drawing.settle(next, [...next.grid.joints.keys()].slice(d.grid.joints.length));
  },
  split: (d, c, r) => {
    const t = c.pick([undefined, r(), 0, NaN, 1e-9]);
    return drawing.splitBeam(d, c.index(d.grid.beams.length), t);
  },
  onBeam: (d, c) => drawing.addJointOnBeam(d, c.index(d.grid.beams.length), c.point()),
  goal: (d, c, r) => addGoal(d, vertex(d, c), [c.x(), c.x(), c.x()], c.pick([1, r(), 0, -1, NaN])),
  goal2: (d, c) => addGoal(d, vertex(d, c), [c.x(), c.x(), c.x()]),
  goal3: (d, c) => addGoal(d, vertex(d, c), [c.x(), c.x(), c.x()]),
  moveGoal: (d, c) => moveGoal(d, c.index(d.goals.length), [c.x(), c.x(), c.x()]),
  weight: (d, c, r) => setWeight(d, c.index(d.goals.length), c.pick([r(), NaN, -1])),
  noGoal: (d, c) => removeGoal(d, c.index(d.goals.length)),
};

function selection(d, c) {
  return { joints: c.some(d.grid.joints.length), beams: c.some(d.grid.beams.length) };
}

function vertex(d, c) {
  return c.pick([
    ["joint", c.index(d.grid.joints.length), c.pick(["centre", 0, 3, 6, 8])],
    ["beam", c.index(d.grid.beams.length), c.pick(["start", "middle", "end"]), c.pick(["centre", 0, 3])],
  ]);
}

test("every edit keeps the document well-formed, changes nothing in place, and is undone", () => {
  const changed = new Map(Object.keys(EDITS).map((name) => [name, 0]));
  let followed = 0;
  for (let seed = 0; seed < SEEDS; seed += 1) {
    const random = seeded(seed);
    const all = choices(random);
    let document = frozen(emptyDocument());
    let history = emptyHistory();
    const passed = [document];
    for (let step = 0; step < STEPS; step += 1) {
      const few = document.grid.joints.length < 4;
      const name = few || random() < 0.2 ? "polyline" : all.pick(Object.keys(EDITS));
      const next = EDITS[name](document, all, random);
      if (next === document) continue;
      assertWellFormed(next);
      changed.set(name, changed.get(name) + 1);
      history = record(history, document, name);
      document = frozen(next);
      passed.push(document);
    }
    followed += document.goals.length;
    for (const before of passed.slice(0, -1).reverse()) {
      ({ document, history } = undone(history, document));
      assert.equal(document, before);
    }
    for (const after of passed.slice(1)) {
      ({ document, history } = redone(history, document));
      assert.equal(document, after);
    }
  }
  for (const [name, count] of changed) assert.ok(count > 5, `${name} changed only ${count} documents`);
  assert.ok(followed > 20, `only ${followed} goals lasted`);
});

test("random documents travel in links", async () => {
  const random = seeded(3);
  const all = choices(random);
  let document = emptyDocument();
  for (let step = 0; step < 30; step += 1) {
    document = EDITS[all.pick(["polyline", "goal", "goal2", "rotate", "set"])](document, all, random);
    assert.deepEqual(await decode(await encode(document)), document);
  }
});

/** Return the pairs of beams that cross, without running over each other, away from common joints. */
function crossings({ joints, beams }) {
  const pairs = [];
  beams.forEach((one, a) => beams.slice(a + 1).forEach((other) => {
    if (one.some((k) => other.includes(k))) return;
    const ends = [...one, ...other].map((k) => joints[k]);
    const point = crossing(...ends);
    if (point && !overlapping(...ends, 1.5)) pairs.push([point, one, other]);
  }));
  return pairs;
}

/** Return whether all joints, and joints and beams that are not their own, lie apart. */
function roomy({ joints }, least) {
  return joints.every((p, k) => joints.slice(k + 1).every((q) => distance(p, q) > least));
}

test("after lines are drawn or dragged, no beams cross without a joint", () => {
  let tried = 0;
  for (let seed = 100; seed < 160; seed += 1) {
    const random = seeded(seed);
    const all = choices(random);
    const place = () => [random() * 200, random() * 200];
    let document = emptyDocument();
    for (let line = 0; line < 4; line += 1)
      document = drawing.addPolyline(document, Array.from({ length: 3 }, place));
    const k = Math.floor(random() * document.grid.joints.length);
    const dragged = drawing.settle(edit.placeJoint(document, k, place()), [k]);
    for (const next of [document, dragged]) {
      if (!roomy(next.grid, 2.5)) continue;
      tried += 1;
      assert.deepEqual(crossings(next.grid), [], `seed ${seed}`);
    }
  }
  assert.ok(tried > 30, `only ${tried} were clear enough`);
});

test("drawing a part of the grid again changes nothing", () => {
  for (let seed = 0; seed < 30; seed += 1) {
    const random = seeded(seed);
    let document = emptyDocument();
    const place = () => [random() * 200, random() * 200];
    for (let line = 0; line < 4; line += 1)
      document = drawing.addPolyline(document, Array.from({ length: 3 }, place));
    if (!roomy(document.grid, 2.5)) continue;
    for (const [i, j] of document.grid.beams) {
      const { joints } = document.grid;
      assert.equal(drawing.addPolyline(document, [joints[j], joints[i]]), document);
    }
    assert.equal(drawing.settle(document, [...document.grid.joints.keys()]), document);
  }
});
