// Drawings of other programs: sizes by unit, and mends that are done or not.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  allMends, heightFor, patternOf, sizesBy, withEntry,
} from "../../../src/simulearn/studio/page/document/imported.js";
import { near } from "./support.mjs";

const mend = (code, count = 1) => ({ code, count, message: code, places: [[0, 0]] });

test("every unit gives a size, and one that only the file knows is added", () => {
  const sizes = sizesBy([2, 1], [{ name: "yd", mm: 914.4 }, { name: "mm", mm: 1 }, null]);
  const of = (unit) => sizes.find((one) => one.unit === unit).size;
  assert.deepEqual(of("mm"), [2, 1]);
  assert.deepEqual(of("in"), [50.8, 25.4]);
  assert.deepEqual(of("yd"), [1828.8, 914.4]);
  assert.equal(sizes.filter(({ unit }) => unit === "mm").length, 1);
  near(of("pt")[0], 2 * of("in")[0] / 144);
});

test("a unit that is only a width has no name in the list", () => {
  assert.ok(!sizesBy([1, 1], [{ name: "unit", mm: 2 }]).some(({ unit }) => unit === "unit"));
  assert.equal(heightFor([2, 1], 100), 50);
  assert.equal(heightFor([0, 1], 100), null);
});

test("a mend that is not to be done stays in its place in the list", () => {
  const first = allMends([], [mend("gap", 4), mend("stub"), mend("leaf")], []);
  assert.deepEqual(first.map(({ code, done }) => [code, done]), [["gap", true], ["stub", true], ["leaf", true]]);
  const second = allMends(first, [mend("gap", 3), mend("crossing")], ["stub"]);
  assert.deepEqual(second.map(({ code, count, done }) => [code, count, done]),
    [["gap", 3, true], ["stub", 1, false], ["crossing", 1, true]]);
  const third = allMends(second, [mend("gap", 4), mend("stub", 2), mend("leaf")], []);
  assert.deepEqual(third.map(({ code, count, done }) => [code, count, done]),
    [["gap", 4, true], ["stub", 2, true], ["leaf", 1, true]]);
});

test("a list with an entry or without it", () => {
  assert.deepEqual(withEntry(["a"], "b", true), ["a", "b"]);
  assert.deepEqual(withEntry(["a", "b"], "b", true), ["a", "b"]);
  assert.deepEqual(withEntry(["a", "b"], "a", false), ["b"]);
});

test("a name as a pattern fits itself only", () => {
  assert.equal(patternOf("top 0.5"), "top 0.5");
  assert.equal(patternOf("a[1]*?"), "a[[]1][*][?]");
});
