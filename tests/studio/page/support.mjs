// What tests of the page's functions share: random numbers from a seed, and what every document is.

import assert from "node:assert/strict";
import { emptyDocument, readDocument } from "../../../src/simulearn/studio/page/document/document.js";

/** Return a function that gives random numbers in [0, 1), the same for the same seed (mulberry32). */
export function seeded(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** Return a document with joints, beams and goals. */
export function documentOf(joints, beams, { actuators = beams.map(() => 0), fixed = 0, goals = [] } = {}) {
  const document = emptyDocument();
  const all = goals.map((goal) => ({ target: [0, 0, 0], weight: 1, ...goal }));
  return { ...document, grid: { ...document.grid, joints, beams, actuators, fixed }, goals: all };
}

/** A square of 60 mm with its joints counter-clockwise from the origin. */
export function square(options) {
  return documentOf([[0, 0], [60, 0], [60, 60], [0, 60]], [[0, 1], [1, 2], [2, 3], [3, 0]], options);
}

/** Return a document with all that was in it frozen, so that a change in place is an error. */
export function frozen(value) {
  if (typeof value === "object" && value !== null && !Object.isFrozen(value)) {
    Object.freeze(value);
    Object.values(value).forEach(frozen);
  }
  return value;
}

/** Check what holds for every document: what is read back equals it, goals have vertices of their own. */
export function assertWellFormed(document) {
  assert.deepEqual(readDocument(JSON.parse(JSON.stringify(document))), document);
  const vertices = document.goals.map(({ vertex }) => vertex.join());
  assert.equal(new Set(vertices).size, vertices.length, "two goals have one vertex");
}

/** Return the beams of a grid as a sorted list of the places of their ends. */
export function edges({ joints, beams }) {
  return beams.map((ends) => ends.map((k) => joints[k].join()).sort().join(" - ")).sort();
}

export function near(a, b, tolerance = 1e-6) {
  assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);
}
