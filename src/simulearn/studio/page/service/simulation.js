// Simulates the document whenever its grid changes: one question at a time, the last change wins.

import { watch } from "/libraries/vue.js";
import { simulate } from "./api.js";
import { state } from "../store.js";

const AGAIN = 2000; // ms until a question is put again that the server did not take

let asking = false;
let retry = 0;

/** Begin to answer every change of the grid. */
export function startSimulation() {
  watch(() => state.document.grid, ask, { immediate: true });
}

/** Ask about the current document, unless a question is out already: then after its answer. */
export async function ask() {
  clearTimeout(retry);
  if (asking) return;
  asking = true;
  while (state.document.grid !== state.check?.document.grid) {
    const { document } = state;
    if (document.grid.beams.length === 0) {
      state.check = { document, errors: [], warnings: [], netLengths: {} };
      state.answer = null;
      break;
    }
    state.busy = true;
    const begun = performance.now();
    try {
      const [result] = await simulate([document.grid], { materials: document.materials });
      accept(document, result, performance.now() - begun);
    } catch (problem) {
      state.problem = problem;
      if (problem.offline || problem.status >= 500 || problem.status === 429) {
        state.connection = problem.offline ? "offline" : state.connection;
        retry = setTimeout(ask, AGAIN);
        break;
      }
      state.check = { document, errors: problem.errors, warnings: [], netLengths: {} };
    }
  }
  asking = false;
  state.busy = false;
}

/** Take over the outcome of a document. */
export function accept(document, result, milliseconds) {
  state.connection = "online";
  state.problem = null;
  state.check = {
    document,
    errors: result.ok ? [] : failureMessages(result),
    warnings: result.warnings ?? [],
    netLengths: result.net_lengths,
  };
  if (result.ok) state.answer = { document, result, milliseconds };
}

/** Return what is wrong as messages with code, where and message. */
function failureMessages({ errors, code, where, message, hint }) {
  return errors.length ? errors : [{ code, where, message: hint ? `${message}; ${hint}` : message }];
}
