// The print of the current design: its toolpath to look at, and its G-code to download.
// state.print has document, toolpath, facts, layer (1 to n), travels, state: "asking", "ready",
// "failed", problem. An older toolpath stays until the new one is there; `freshPrint` says which it is.

import { state } from "../store.js";
import { printFile, toolpath } from "./api.js";
import { fileName } from "./beads.js";
import { download } from "./downloads.js";
import { latest } from "./latest.js";

const QUIET = 300; // ms without a change until a toolpath is asked for
const AGAIN = 3000; // ms until a server that was busy or away is asked again

const NOTHING = { document: null, toolpath: null, facts: null };
const questions = latest(QUIET);
const retries = latest(AGAIN);

/** Return whether the toolpath is that of the current design and printer. */
export function freshPrint() {
  const of = state.print?.of;
  return Boolean(of) && of.grid === state.document.grid && of.printer === state.document.printer;
}

/** Ask for the toolpath of the current design, unless it is there. */
export function askPrint() {
  retries.drop();
  const { document } = state;
  const { grid, printer, materials } = document;
  const update = (more) => {
    state.print = { ...NOTHING, layer: 1, travels: false, ...state.print, ...more };
  };
  if (grid.beams.length === 0) {
    questions.drop();
    state.print = null;
    return;
  }
  if (freshPrint() && state.print.state !== "asking") return;
  update({ state: "asking", problem: null });
  questions.ask((signal) => toolpath([[grid], printer, materials], signal), (answer, problem) => {
    if (problem) {
      // Its toolpath would be that of another design, or of another bed.
      update({ ...NOTHING, of: { grid, printer }, state: "failed", problem });
      if (problem.offline || problem.status === 429 || problem.status >= 500) {
        update({ of: null });
        retries.ask(async () => null, askPrint);
      }
      return;
    }
    const before = state.print;
    const count = answer.layers.length;
    const layer = before.toolpath?.layers.length === count ? before.layer : count;
    update({
      of: { grid, printer }, document, toolpath: answer, facts: answer.print, layer, state: "ready",
    });
  });
}

/** Give up what is being asked. */
export function dropPrint() {
  questions.drop();
  retries.drop();
}

/** Show a layer, 1 to n, or whether travels are drawn. */
export function showLayer(layer) {
  state.print = { ...state.print, layer: Math.min(state.print.toolpath.layers.length, Math.max(1, layer)) };
}

export function showTravels(travels) {
  state.print = { ...state.print, travels };
}

/** Have the browser save the file that prints the current design: "gcode" or "gcode.3mf". */
export async function downloadPrint(format) {
  const { grid, printer, materials, name } = state.document;
  const file = await printFile([[grid], printer, materials], [fileName(name)], format);
  download(file.blob, file.name);
}
