// What is printed on a layer, and the file's name.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fileName, lengthsOf, sizeOf } from "../../../src/simulearn/studio/page/service/beads.js";
import { bedLines } from "../../../src/simulearn/studio/page/shape/bed.js";
import { ribbonsOf, TONES } from "../../../src/simulearn/studio/page/shape/ribbons.js";

const PATH = { // a skirt and a square on the first layer, a line on the second
  roles: ["skirt", "shell", "active", "passive", "joint", "brim"],
  layers: [{ z: 0.25 }, { z: 0.5 }],
  layer_of: [0, 0, 1], role: [0, 1, 3], drawn: [false, false, false], starts: [0, 2, 7, 9],
  points: [[-50, -50], [150, -50], [0, 0], [60, 0], [60, 80], [0, 80], [0, 0], [0, 0], [3, 4]],
  width: [0.5, 0, 0.5, 0.5, 0.5, 0.5, 0, 0.5, 0],
};

test("lengths of a layer are by role", () => {
  const first = { skirt: 200, shell: 280, active: 0, passive: 0, joint: 0, brim: 0 };
  assert.deepEqual(Object.fromEntries(lengthsOf(PATH, 1)), first);
  assert.equal(lengthsOf(PATH, 2).get("passive"), 5);
});

test("the size of a print is without its skirt and with the width of its beads", () => {
  assert.deepEqual(sizeOf(PATH), [60.5, 80.5, 0.5]);
});

test("a brim is no part of the size", () => {
  assert.deepEqual(sizeOf({ ...PATH, role: [5, 1, 3] }), [60.5, 80.5, 0.5]);
});

test("travels with filament drawn back are distinguished from the others, layer by layer", () => {
  const { travels } = ribbonsOf({ ...PATH, drawn: [false, true, false] });
  assert.deepEqual(travels.drawn, { points: [150, -50, 0.25, 0, 0, 0.25], start: [0, 2, 2] });
  assert.deepEqual(travels.kept, { points: [], start: [0, 0, 0] });
});

test("every role has a tone, active beads of the upper half one of their own", () => {
  const tones = (role) => {
    const ribbons = ribbonsOf({ ...PATH, role: [role, role, role] });
    return [ribbons.tones[0], ribbons.tones.at(-1)].map((n) => TONES[n]);
  };
  PATH.roles.forEach((name, role) => {
    assert.deepEqual(tones(role), [name, name === "active" ? "upper" : name]);
  });
});

const BED = { shape: null, low: [0, 0], high: [100, 60], excluded: [[[90, 60], [70, 50]]] };
const points = (lines) => Array.from({ length: lines.length / 3 }, (_, k) => lines.slice(3 * k, 3 * k + 2));

test("a bed is a frame, with zones that are hatched within their bounds", () => {
  const { outline, cells, excluded } = bedLines(BED);
  assert.deepEqual(new Set(points(outline).map(String)), new Set(["0,0", "100,0", "100,60", "0,60"]));
  assert.equal(points(cells).length, 2 * (6 + 4)); // lines at every 20 mm
  const zone = points(excluded);
  assert.equal(zone.length, 8 + 2 * 4);
  assert.ok(zone.every(([x, y]) => x >= 70 && x <= 90 && y >= 50 && y <= 60));
});

test("a round bed is a ring, and its cells end on it", () => {
  const { outline, cells } = bedLines({ ...BED, shape: "round", low: [-90, -90], high: [90, 90] });
  for (const [x, y] of points(outline)) assert.ok(Math.abs(Math.hypot(x, y) - 90) < 1e-9);
  for (const [x, y] of points(cells)) assert.ok(Math.abs(Math.hypot(x, y) - 90) < 1e-9);
});

test("file names have nothing that a card reader or a shell stumbles over", () => {
  assert.equal(fileName("Tür & Tor: 2"), "tur-tor-2");
  assert.equal(fileName("../../etc"), "etc");
  assert.equal(fileName("  …  "), "grid");
  assert.equal(fileName("x".repeat(200)).length, 60);
});
