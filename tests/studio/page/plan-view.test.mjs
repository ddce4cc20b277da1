// The plan's camera, its drawing grid and where panels go.

import assert from "node:assert/strict";
import { test } from "node:test";

const PLAN = "../../../src/simulearn/studio/page/plan";
const camera = await import(`${PLAN}/camera.js`);
const { gridLines, gridStep, scaleBar } = await import(`${PLAN}/gridlines.js`);
const { beside, clamped } = await import(`${PLAN}/placement.js`);
const { Wheel, wheelUse } = await import(`${PLAN}/wheel.js`);

const SIZE = { width: 800, height: 600 };
const near = (a, b) => assert.ok(a.every((x, k) => Math.abs(x - b[k]) < 1e-9), `${a} is not ${b}`);

test("pixels and millimetres are each other's inverse, with y upwards", () => {
  const one = { x: 120, y: 300, scale: 2.5 };
  near(camera.toPlan(one, camera.toScreen(one, [17, -4])), [17, -4]);
  assert.ok(camera.toScreen(one, [0, 10])[1] < camera.toScreen(one, [0, 0])[1]);
});

test("zooming keeps the point under the pointer, up to the limits too", () => {
  const one = { x: 120, y: 300, scale: 2.5 };
  for (const factor of [1.3, 0.2, 1e6, 1e-6]) {
    const zoomed = camera.zoomAt(one, [400, 50], factor);
    near(camera.toPlan(zoomed, [400, 50]), camera.toPlan(one, [400, 50]));
    assert.ok(zoomed.scale >= camera.LEAST_SCALE && zoomed.scale <= camera.MOST_SCALE);
  }
});

test("two fingers keep what is under each of them", () => {
  const one = { x: 120, y: 300, scale: 2.5 };
  const moved = camera.pinch(one, [[100, 100], [200, 100]], [[80, 130], [280, 130]]);
  assert.equal(moved.scale, 5);
  near(camera.toPlan(moved, [80, 130]), camera.toPlan(one, [100, 100]));
  near(camera.toPlan(moved, [280, 130]), camera.toPlan(one, [200, 100]));
});

test("fitting shows the whole box inside the margins", () => {
  const margin = { left: 80, right: 40, top: 50, bottom: 60 };
  const fitted = camera.fit({ x: [-300, 100], y: [0, 900] }, SIZE, margin);
  const [left, top] = camera.toScreen(fitted, [-300, 900]);
  const [right, bottom] = camera.toScreen(fitted, [100, 0]);
  assert.ok(left >= 80 - 1e-9 && right <= 760 + 1e-9 && top >= 50 - 1e-9 && bottom <= 540 + 1e-9);
  assert.ok(Number.isFinite(camera.fit({ x: [3, 3], y: [4, 4] }, SIZE, margin).scale));
});

test("handles follow the zoom in steps that nobody sees", () => {
  for (const scale of [0.01, 0.3, 1, 2.97, 60])
    assert.ok(Math.abs(camera.sizeScale(scale) / scale - 1) < 0.026);
  assert.equal(camera.sizeScale(3), camera.sizeScale(3.01));
});

test("the drawing grid is of 10 mm at usual zooms and suits others", () => {
  assert.equal(gridStep(3), 10);
  assert.equal(gridStep(1), 10);
  for (const scale of [0.01, 0.3, 0.7, 1, 3, 8, 20, 60]) {
    const gap = gridStep(scale) * scale;
    assert.ok(gap >= 9 - 1e-9 && gap < 100, `${gap} px at ${scale}`);
    const { px } = scaleBar(scale);
    assert.ok(px >= 60 - 1e-9 && px <= 160, `${px} px`);
  }
});

test("every fifth line is a major one and none is drawn twice", () => {
  const { minor, major } = gridLines({ x: 0, y: 600, scale: 3 }, { width: 300, height: 600 });
  const across = (path) => [...path.matchAll(/M([\d.]+) 0V/g)].map(([, x]) => Number(x));
  assert.deepEqual(across(major), [0.5, 150.5, 300.5]);
  assert.equal(across(minor).length, 8);
});

test("a panel lies beside the beam, away from the grid, inside the view", () => {
  const panel = { width: 240, height: 110 };
  const above = beside([[300, 200], [500, 200]], [400, 300], panel, SIZE);
  assert.ok(above[1] + panel.height < 200);
  const below = beside([[300, 400], [500, 400]], [400, 300], panel, SIZE);
  assert.ok(below[1] > 400);
  const edge = beside([[790, 10], [795, 590]], [400, 300], panel, SIZE);
  assert.ok(edge[0] + panel.width <= 790);
  near(clamped([900, 900], panel, SIZE), [552, 482]);
});

test("the wheel zooms, two fingers pan, a pinch zooms, a selected beam is changed", () => {
  const event = (more) => ({ deltaX: 0, deltaY: 100, deltaMode: 0, ...more });
  assert.equal(wheelUse(event(), null), "zoom");
  assert.equal(wheelUse(event(), "plain"), "zoom");
  assert.equal(wheelUse(event(), "selected"), "actuator");
  assert.equal(wheelUse(event({ altKey: true }), "plain"), "actuator");
  assert.equal(wheelUse(event({ deltaY: 4 }), "selected"), "pan");
  assert.equal(wheelUse(event({ ctrlKey: true, deltaY: 4 }), "selected"), "pinch");
  assert.equal(wheelUse(event({ shiftKey: true }), null), "across");
});

test("a flood of wheel events is one movement a frame, and what it does stays until it rests", () => {
  const wheel = new Wheel();
  const event = (deltaY) => ({ deltaX: 0, deltaY, deltaMode: 0, ctrlKey: false, metaKey: false });
  wheel.add(event(-100), 0, () => null);
  for (let k = 1; k < 50; k += 1) wheel.add(event(-2), k, () => "selected");
  const zoomed = wheel.take();
  assert.equal(zoomed.use, "zoom");
  assert.ok(zoomed.factor > 1);
  assert.equal(wheel.take().factor, 1);
  wheel.add(event(-100), 1000, () => "selected");
  assert.deepEqual(wheel.take(), { use: "actuator", steps: 1 });
  assert.equal(wheel.take().steps, 0);
});
