// Time, handles and the ribbons of a print.

import assert from "node:assert/strict";
import { test } from "node:test";
import { dimensionItems } from "../../../src/simulearn/studio/page/shape/dimensions.js";
import { dragged, gizmoItems } from "../../../src/simulearn/studio/page/shape/gizmo.js";
import { ribbonsOf } from "../../../src/simulearn/studio/page/shape/ribbons.js";
import {
  advance, clockAt, HOLD, momentOf, nextFrame, PASS, snapFrame,
} from "../../../src/simulearn/studio/page/shape/timeline.js";
import { shape } from "../../../src/simulearn/studio/page/text/shape.js";

const near = (a, b, by = 1e-6) => assert.ok(Math.abs(a - b) <= by, `${a} is not near ${b}`);

test("playing goes from flat to morphed, waits, and begins again", () => {
  let { clock, frame } = advance(clockAt(11), 0, true);
  assert.equal(frame, 0);
  ({ clock, frame } = advance(clock, PASS / 2, true));
  near(frame, 5.5);
  near(clockAt(frame), clock);
  ({ clock, frame } = advance(clock, PASS / 2 + HOLD / 2, true));
  assert.equal(frame, 11);
  assert.deepEqual(advance(clock, HOLD, true), { clock: 0, frame: 0, playing: true });
  assert.deepEqual(advance(PASS, 0.1, false), { clock: PASS, frame: 11, playing: false });
});

test("the slider stops at frames, keys go from frame to frame", () => {
  assert.equal(snapFrame(4.1), 4);
  assert.equal(snapFrame(4.4), 4.4);
  assert.equal(nextFrame(4, 1), 5);
  assert.equal(nextFrame(4.4, 1), 5);
  assert.equal(nextFrame(4.4, -1), 4);
  assert.equal(nextFrame(11, 1), 11);
  assert.equal(nextFrame(0, -1), 0);
});

test("moments have names in both languages", () => {
  assert.deepEqual(momentOf(0), { key: "flat", values: {} });
  assert.deepEqual(momentOf(4), { key: "released", values: { percent: 40 } });
  assert.deepEqual(momentOf(10), { key: "released", values: { percent: 100 } });
  assert.equal(momentOf(10.5).key, "creeping");
  assert.equal(momentOf(11).key, "crept");
  assert.deepEqual(Object.keys(shape.de).sort(), Object.keys(shape.en).sort());
  for (const [key, text] of Object.entries(shape.en)) {
    const names = (string) => (string.match(/\{\w+\}/g) ?? []).sort();
    assert.deepEqual(names(shape.de[key]), names(text), key);
  }
});

test("a handle moves along its axis or in its plane", () => {
  const eye = [100, -100, 80];
  const ray = (point) => ({ origin: eye, direction: point.map((x, k) => x - eye[k]) });
  const start = [10, 20, 30];
  const along = dragged(start, { axis: [0, 0, 1] }, ray([10, 20, 35]), ray([10, 20, 42]));
  [10, 20, 37].forEach((x, k) => near(along[k], x));
  const inPlane = dragged(start, { normal: [0, 0, 1] }, ray([11, 22, 30]), ray([16, 19, 30]));
  [15, 17, 30].forEach((x, k) => near(inPlane[k], x));
  const away = { origin: [0, 0, 0], direction: [0, 0, 1] };
  assert.equal(dragged(start, { axis: [0, 0, 1] }, away, away), start);
});

test("an axis that points at the viewer has no handle", () => {
  const above = ([x, y]) => ({ x, y, seen: true });
  const ids = gizmoItems([0, 0, 0], 80, above, { onPress() {}, name: (axes) => axes }).map(({ id }) => id);
  assert.ok(ids.includes("axis-x") && ids.includes("axis-y") && ids.includes("plane-z"));
  assert.ok(!ids.includes("axis-z") && !ids.includes("plane-x"));
});

test("dimensions have the sides of the box", () => {
  const items = dimensionItems({ low: [-10, 0, 5], high: [20, 8, 6] }, (x) => `${x}`);
  assert.deepEqual(items.filter(({ kind }) => kind === "text").map(({ text }) => text), ["30", "8", "1"]);
});

test("ribbons are as wide as their beads, and layers are ranges of them", () => {
  const toolpath = {
    roles: ["skirt", "shell", "active", "passive", "joint"], layers: [{ z: 0.2 }, { z: 0.4 }],
    starts: [0, 2, 5, 7], layer_of: [0, 0, 1], role: [2, 1, 2], drawn: [false, false, true],
    points: [[0, 0], [10, 0], [20, 0], [20, 10], [30, 10], [0, 5], [0, 9]],
    width: [0.5, 0, 0.4, 0.4, 0, 0.6, 0],
  };
  const { positions, tones, index, layerStart, travels } = ribbonsOf(toolpath);
  assert.deepEqual(layerStart, [0, 18, 24]);
  assert.equal(index.length, 24);
  near(positions[4] - positions[1], 0.5);
  const corner = [...positions.subarray(6 * 3, 6 * 3 + 6)]; // the corner of the second bead is mitred
  near(Math.hypot(corner[3] - corner[0], corner[4] - corner[1]), 0.4 * Math.SQRT2, 1e-5);
  assert.deepEqual([tones[0], tones[4], tones[10]], [2, 1, 5]); // the upper half has another colour
  assert.deepEqual(travels.kept, { points: [10, 0, 0.2, 20, 0, 0.2], start: [0, 2, 2] });
});
