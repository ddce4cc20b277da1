// How prints of the design differ, by the scatter of its material: asked for, and again when it changes.
// state.spread has document, state: "asking", "ready", "failed", result: with `scatter` and `prints`, problem.

import { state } from "../store.js";
import { simulate } from "./api.js";
import { latest } from "./latest.js";

const PRINTS = 300;
const questions = latest(0);

/** Ask how prints of the present design differ. */
export function askSpread() {
  const { document } = state;
  state.spread = { document, state: "asking", result: null };
  const { materials } = document;
  questions.ask((signal) => simulate([document.grid], { materials, prints: PRINTS, signal }), (results, problem) => {
    const [result] = results ?? [];
    state.spread = { document, state: result?.ok ? "ready" : "failed", result, problem };
  });
}

/** Stop showing how prints differ. */
export function dropSpread() {
  questions.drop();
  state.spread = null;
}

/** Return the result of the spread, where it is of the present design; else null. */
export function freshSpread() {
  const { spread, document } = state;
  return spread?.state === "ready" && spread.document.grid === document.grid ? spread.result : null;
}
