// Where a pointer in the plan snaps to, and lengths and angles there.

import assert from "node:assert/strict";
import { test } from "node:test";
import * as measure from "../../../src/simulearn/studio/page/document/measure.js";
import { snap } from "../../../src/simulearn/studio/page/document/snapping.js";
import { emptyDocument } from "../../../src/simulearn/studio/page/document/document.js";
import { documentOf, near, seeded, square } from "./support.mjs";

const FREE = { document: emptyDocument(), grid: 0, angle: 0, lengths: false, radius: 3 };

test("a joint is before a beam, a beam before lines and the grid", () => {
  const document = square();
  assert.deepEqual(snap([61, 1], { document }), { guides: [], point: [60, 0], kind: "joint", joint: 1 });
  const beam = snap([41, 1], { document });
  assert.deepEqual([beam.kind, beam.beam, beam.point], ["beam", 0, [41, 0]]);
  near(beam.t, 41 / 60);
  const middle = snap([31, 1], { document });
  assert.deepEqual([middle.point, middle.t], [[30, 0], 0.5]);
  const level = snap([101, 58.5], { document });
  assert.deepEqual([level.kind, level.point], ["align", [100, 60]]);
  assert.deepEqual(level.guides, [[[60, 60], [100, 60]]]);
  assert.deepEqual(snap([101, 92], { document, radius: 1 }), { guides: [], point: [100, 90], kind: "grid" });
  assert.deepEqual(snap([101.2, 92], { document, grid: 0, radius: 1 }).point, [101.2, 92]);
  assert.equal(snap([101.2, 92], { document, grid: 0, radius: 1 }).kind, "none");
});

test("two lines with joints meet", () => {
  const document = documentOf([[0, 0], [60, 40]], [[0, 1]]);
  const found = snap([1, 41], { document });
  assert.deepEqual([found.kind, found.point, found.guides.length], ["align", [0, 40], 2]);
});

test("moved joints and their beams do not count", () => {
  const document = square();
  assert.notEqual(snap([61, 1], { document, exclude: [1] }).joint, 1);
  const found = snap([41, 1], { document, exclude: [1], grid: 0, radius: 0.5 });
  assert.equal(found.kind, "none");
});

test("crossing beams and directions give their crossing", () => {
  const document = documentOf([[0, 0], [60, 60], [0, 60], [60, 0]], [[0, 1], [2, 3]]);
  const cross = snap([31, 30], { document });
  assert.deepEqual([cross.kind, cross.point], ["crossing", [30, 30]]);
  const ray = snap([39, 41], { document, from: [40, -20], radius: 2 });
  assert.deepEqual([ray.kind, ray.point], ["crossing", [40, 40]]);
  assert.deepEqual(ray.guides, [[[40, -20], [40, 40]]]);
});

test("a line from a joint snaps to directions and lengths", () => {
  const from = [0, 0];
  const flat = snap([52, 1], { ...FREE, from, angle: 15 });
  assert.deepEqual([flat.kind, flat.point, flat.text], ["angle", [52, 0], "52 mm · 0°"]);
  const long = snap([52, 1], { ...FREE, from, angle: 15, grid: 5, lengths: true });
  assert.deepEqual([long.kind, long.point], ["length", [50, 0]]);
  const slope = snap([40, 40.5], { ...FREE, from, angle: 45 });
  near(measure.angle(from, slope.point), 45);
  assert.equal(snap([50, 10], { ...FREE, from, angle: 90 }).kind, "none");
  const document = documentOf([[100, 100], [143, 100]], [[0, 1]]);
  const equal = snap([42, 0.5], { document, from, radius: 3 });
  assert.deepEqual([equal.kind, equal.point], ["length", [43, 0]]); // as long as the beam
  const level = snap([101, 1], { document, from, radius: 3 });
  assert.deepEqual([level.kind, level.point, level.guides[1]], ["angle", [100, 0], [[100, 100], [100, 0]]]);
});

test("the start itself and an empty document give a place", () => {
  assert.deepEqual(snap([1, 1], { ...FREE, from: [1, 1], angle: 15 }).point, [1, 1]);
  assert.deepEqual(snap([7, 8], { document: emptyDocument() }).point, [5, 10]);
  assert.deepEqual(snap([7, 8], { document: emptyDocument(), from: [0, 0] }).guides.length <= 2, true);
});

test("a snapped point is near, finite, and snaps to itself", () => {
  const random = seeded(11);
  const points = Array.from({ length: 30 }, () => [random() * 200, random() * 200]);
  const document = documentOf(points, points.slice(1).map((_, k) => [k, k + 1]));
  for (let n = 0; n < 500; n += 1) {
    const point = [random() * 220 - 10, random() * 220 - 10];
    const from = random() < 0.5 ? null : points[Math.floor(random() * 30)];
    const found = snap(point, { document, from, grid: 5, radius: 3 });
    assert.ok(found.point.every(Number.isFinite));
    assert.ok(measure.distance(point, found.point) <= 8, found.kind);
    assert.ok(found.guides.flat(2).every(Number.isFinite));
    if (found.kind === "joint") assert.deepEqual(found.point, points[found.joint]);
    if (found.kind === "beam")
      near(measure.nearestBeam(document.grid, found.point).distance, 0, 1e-5);
  }
});

test("lengths, angles and bounds", () => {
  const { grid } = square();
  assert.equal(measure.beamLength(grid, 1), 60);
  assert.deepEqual([0, 1, 2, 3].map((b) => measure.beamAngle(grid, b)), [0, 90, 180, -90]);
  assert.deepEqual(measure.bounds(grid), {
    min: [0, 0], max: [60, 60], middle: [30, 30], width: 60, height: 60,
  });
  assert.equal(measure.bounds(emptyDocument().grid), null);
  assert.deepEqual(measure.beamsAt(grid, 0), [0, 3]);
  assert.deepEqual(measure.nearestJoint(grid, [50, 5]).number, 1);
  assert.deepEqual(measure.nearestJoint(grid, [50, 5], { exclude: [1] }).number, 0);
  assert.deepEqual(measure.nearestBeam(grid, [30, -9]), { number: 0, t: 0.5, point: [30, 0], distance: 9 });
  assert.equal(measure.nearestBeam(emptyDocument().grid, [0, 0]), null);
});
