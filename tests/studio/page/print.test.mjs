// What is printed on a layer, and the file's name.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fileName, lengthsOf, sizeOf } from "../../../src/simulearn/studio/page/service/beads.js";

const PATH = { // a skirt and a square on the first layer, a line on the second
  roles: ["skirt", "shell", "active", "passive", "joint"],
  layers: [{ z: 0.25 }, { z: 0.5 }],
  layer_of: [0, 0, 1], role: [0, 1, 3], starts: [0, 2, 7, 9],
  points: [[-50, -50], [150, -50], [0, 0], [60, 0], [60, 80], [0, 80], [0, 0], [0, 0], [3, 4]],
  width: [0.5, 0, 0.5, 0.5, 0.5, 0.5, 0, 0.5, 0],
};

test("lengths of a layer are by role", () => {
  const first = { skirt: 200, shell: 280, active: 0, passive: 0, joint: 0 };
  assert.deepEqual(Object.fromEntries(lengthsOf(PATH, 1)), first);
  assert.equal(lengthsOf(PATH, 2).get("passive"), 5);
});

test("the size of a print is without its skirt and with the width of its beads", () => {
  assert.deepEqual(sizeOf(PATH), [60.5, 80.5, 0.5]);
});

test("file names have nothing that a card reader or a shell stumbles over", () => {
  assert.equal(fileName("Tür & Tor: 2"), "tur-tor-2");
  assert.equal(fileName("../../etc"), "etc");
  assert.equal(fileName("  …  "), "grid");
  assert.equal(fileName("x".repeat(200)).length, 60);
});
