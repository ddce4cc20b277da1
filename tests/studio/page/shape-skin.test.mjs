// The surface of a result: placed in the same arrays, at any moment, by its topology.

import assert from "node:assert/strict";
import { test } from "node:test";
import { pick } from "../../../src/simulearn/studio/page/shape/picking.js";
import {
  createSkin, placeSkin, skinBounds, skinVolume, TONE,
} from "../../../src/simulearn/studio/page/shape/skin.js";
import { topologyOf } from "../../../src/simulearn/studio/page/shape/topology.js";
import { bentResult, GRID } from "./shape-support.mjs";

const near = (a, b, by = 1e-3) => assert.ok(Math.abs(a - b) <= by, `${a} is not near ${b}`);
const VOLUME = 7.2 * 4 * (3 * 7.2 + 2 * 50);

test("the flat surface has the volume of the printed body", () => {
  const result = bentResult();
  const skin = placeSkin(createSkin(result, GRID), result, 0);
  near(skinVolume(skin), VOLUME, 0.5);
  const { low, high } = skinBounds(skin);
  [-60.8, -3.6, -2].forEach((x, axis) => near(low[axis], x));
  [60.8, 3.6, 2].forEach((x, axis) => near(high[axis], x));
});

test("between two frames the surface is between theirs", () => {
  const result = bentResult();
  const skin = createSkin(result, GRID);
  const at = (frame) => placeSkin(skin, result, frame).storage.positions.slice();
  const [a, b, middle] = [at(4), at(5), at(4.25)];
  for (let k = 0; k < 3 * skin.vertexCount; k += 1) near(middle[k], 0.75 * a[k] + 0.25 * b[k], 1e-4);
});

test("stations lie exactly where the actuator ends", () => {
  const result = bentResult();
  const skin = placeSkin(createSkin(result, GRID), result, 0);
  const { tones, positions } = skin.storage;
  const vertices = [...Array(skin.vertexCount).keys()];
  const xs = vertices.filter((v) => tones[v] === TONE.bottom).map((v) => positions[3 * v]);
  near(Math.min(...xs), -53.6 + 12.5);
  near(Math.max(...xs), -53.6 + 37.5);
  assert.ok(![...tones.subarray(0, skin.vertexCount)].includes(TONE.top));
});

test("joints have the sides that meet no beam", () => {
  const { joints, beams } = topologyOf(bentResult(), GRID);
  assert.deepEqual(joints.map(({ free }) => free.length), [3, 2, 3]);
  assert.deepEqual(joints.map(({ fixed }) => fixed), [false, true, false]);
  assert.deepEqual(beams.map(({ ends }) => ends), [[0, 1], [1, 2]]);
  near(beams[0].length, 50);
  // Without the grid, the joints of a beam are those at its ends.
  assert.deepEqual(topologyOf(bentResult()).beams.map(({ ends }) => ends), [[0, 1], [1, 2]]);
});

test("storage is used again while it is large enough", () => {
  const result = bentResult();
  const first = createSkin(result, GRID);
  const second = createSkin(result, { ...GRID, actuators: [-0.55, 0] }, { storage: first.storage });
  assert.equal(second.storage, first.storage);
  const finer = createSkin(result, GRID, { storage: first.storage, spacing: 0.5 });
  assert.notEqual(finer.storage, first.storage);
  assert.ok(finer.vertexCount * 3 <= finer.storage.positions.length);
});

test("parts are numbered as in the document", () => {
  const result = { ...bentResult(), joint_numbers: [0, 2, 3], beam_numbers: [1, 4] };
  const beams = [[0, 1], [0, 2], [1, 0], [1, 2], [2, 3]];
  const grid = { ...GRID, beams, actuators: [1, 0, 1, 1, 0.5], fixed: 3 };
  const { parts, topology } = createSkin(result, grid);
  const names = parts.map(({ kind, number }) => `${kind} ${number}`);
  assert.deepEqual(names, ["beam 1", "beam 4", "joint 0", "joint 2", "joint 3"]);
  assert.deepEqual(topology.beams.map(({ ratio }) => ratio), [0, 0.5]);
  assert.deepEqual(topology.joints.map(({ fixed }) => fixed), [false, false, true]);
});

test("a ray meets the first part in its way", () => {
  const result = bentResult();
  const skin = placeSkin(createSkin(result, GRID), result, 0);
  const down = (x, y) => pick(skin, [x, y, 100], [0, 0, -1]);
  assert.equal(down(-30, 1).part.number, 0);
  assert.equal(down(30, -3).part.kind, "beam");
  assert.equal(down(0, 0).part.kind, "joint");
  near(down(0, 0).distance, 98);
  near(down(30, 1).point[2], 2);
  assert.equal(down(0, 5), null);
  const along = pick(skin, [200, 0, 0], [-1, 0, 0]);
  assert.deepEqual([along.part.kind, along.part.number], ["joint", 2]);
});
