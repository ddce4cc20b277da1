// What shapes are coloured by, the colours and the distance of two results.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  calmRange, MAPS, parseColour, sample, table, ticks,
} from "../../../src/simulearn/studio/page/shape/colours.js";
import { deviation } from "../../../src/simulearn/studio/page/shape/deviation.js";
import { createSkin, placeSkin } from "../../../src/simulearn/studio/page/shape/skin.js";
import { fillValues, hasValues, rangeOf } from "../../../src/simulearn/studio/page/shape/values.js";
import { bentResult, GRID } from "./shape-support.mjs";

const near = (a, b, by = 1e-3) => assert.ok(Math.abs(a - b) <= by, `${a} is not near ${b}`);

function filled(by, frame, reference = null, result = bentResult()) {
  const skin = placeSkin(createSkin(result, GRID), result, frame);
  fillValues(skin, result, by, frame, reference);
  return { skin, values: skin.storage.values, positions: skin.storage.positions };
}

function moved(result, by) {
  const shift = (numbers) => numbers.map((x, k) => x + by[k % 3]);
  return { ...result, joints: shift(result.joints), beams: shift(result.beams) };
}

test("heights are those of the vertices, their range that of all frames", () => {
  const { skin, values, positions } = filled("height", 7);
  for (let v = 0; v < skin.vertexCount; v += 1) assert.equal(values[v], positions[3 * v + 2]);
  const [low, high] = rangeOf("height", bentResult());
  near(low, -2, 1e-5);
  assert.ok(high > Math.max(...values.subarray(0, skin.vertexCount)));
});

test("stress goes from section to section, with a step in the middle", () => {
  const { skin, values } = filled("stress", 2);
  const { t, runs } = skin.stations[0];
  const at = (n) => values[12 * n];
  near(at(0), 20); // sections 0 to 3 have 20, 21, 22, 23 MPa in frame 2
  near(at(t.length - 1), 23);
  const middle = runs.findIndex(({ first }) => t[first] === 0.5);
  near(at(runs[middle].first - 1), 21);
  near(at(runs[middle].first), 22);
  assert.deepEqual(rangeOf("stress", bentResult()), [0, 113]);
});

test("a bent beam is longer below and shorter above, as a bent bar is", () => {
  const result = bentResult({ radius: 100 });
  const { skin, values, positions } = filled("strain", 11, null, result);
  const { firstVertex } = skin.parts[0];
  // Strip 0 begins on the lower right edge, strip 3 on the upper left one: strain is z / radius.
  near(values[firstVertex], 2, 0.05);
  near(values[firstVertex + 6], -2, 0.05);
  near(values[firstVertex + 4], 0, 0.05);
  assert.ok(positions.length > 0);
  const [low, high] = rangeOf("strain", result);
  near(high, 2, 0.05);
  assert.equal(low, -high);
});

test("deviation is the distance to the same vertex of the other result", () => {
  const result = bentResult();
  const other = moved(result, [0, 3, 4]);
  const { skin, values } = filled("deviation", 8.5, other);
  for (let v = 0; v < skin.vertexCount; v += 1) near(values[v], 5, 1e-4);
  const { distances, mean, max } = deviation(result, other, 8.5);
  assert.equal(distances.length, 3 * 8 + 2 * 12);
  near(mean, 5);
  near(max, 5);
  near(rangeOf("deviation", result, other)[1], 5);
});

test("what cannot be coloured is known", () => {
  const result = bentResult();
  assert.equal(hasValues("stress", { ...result, mises: undefined }), false);
  assert.equal(hasValues("deviation", result, null), false);
  assert.equal(hasValues("deviation", result, { ...result, beamCount: 3 }), false);
  assert.equal(deviation(result, { ...result, jointCount: 4 }), null);
  assert.equal(hasValues("height", result), true);
});

test("maps get steadily lighter, the diverging one towards its middle", () => {
  const light = ([r, g, b]) => 0.2126 * r ** 2.2 + 0.7152 * g ** 2.2 + 0.0722 * b ** 2.2;
  for (const [name, colours] of Object.entries(MAPS)) {
    const lights = colours.map((colour) => light(parseColour(colour)));
    const middle = name === "diverging" ? 4 : 8;
    for (let k = 1; k < 9; k += 1) assert.ok((lights[k] > lights[k - 1]) === (k <= middle), `${name} ${k}`);
  }
  assert.deepEqual(sample("viridis", -1), parseColour(MAPS.viridis[0]));
  assert.deepEqual(sample("viridis", 1), parseColour(MAPS.viridis[8]));
  assert.deepEqual([...table("viridis", 2)], [0x44, 0x01, 0x54, 255, 0xfd, 0xe7, 0x25, 255]);
});

test("colours of style sheets are read, others are refused", () => {
  assert.deepEqual(parseColour(" #ff0000"), [1, 0, 0]);
  assert.deepEqual(parseColour("#0f0"), [0, 1, 0]);
  assert.deepEqual(parseColour("rgb(0 0 255 / 50%)"), [0, 0, 1]);
  assert.throws(() => parseColour("bluish"), /bluish/);
});

test("ranges are calm, and ticks tell them apart", () => {
  assert.deepEqual(calmRange([-4.93, 46.21]), [-5, 47]);
  assert.deepEqual(calmRange([0, 0.1589]), [0, 0.16]);
  assert.deepEqual(calmRange([0, 0]), [0, 1]);
  assert.deepEqual(calmRange([-16.2, 16.2]), [-17, 17]);
  const marks = ticks([0, 0.16]);
  const written = marks.map(({ value, digits }) => value.toFixed(digits));
  assert.deepEqual(written, ["0.00", "0.04", "0.08", "0.12", "0.16"]);
  const texts = ticks([-5, 47]).map(({ value, digits }) => value.toFixed(digits));
  assert.equal(new Set(texts).size, 5);
});
