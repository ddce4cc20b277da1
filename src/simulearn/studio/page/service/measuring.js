// How far the shape is from its goals, where the server has to say it: goals besides points, or a shape
// that may be placed anywhere. One question at a time, the last change wins. state.measured has
//   document, result: what was compared; other: a preview's result that was compared, too, or null,
//   rows: the entry of the document's goals that each goal is of,
//   shapes: of both { error_mm, distances_mm, lines, place }, problem: why there is no answer.

import { watch } from "/libraries/vue.js";
import { taskOf } from "../document/task.js";
import { isFresh, isMeasured } from "../shape/compared.js";
import { LAST } from "../shape/topology.js";
import { state } from "../store.js";
import { measure } from "./api.js";

const AGAIN = 2000; // ms until a question is put again that the server did not take

let asking = false;
let retry = 0;

/** Begin to compare every shape with its goals while these are looked at. */
export function startMeasuring() {
  watch(() => [state.tab, state.document, state.answer, state.preview], ask);
}

/** Ask about the present shape, unless a question is out already: then after its answer. */
async function ask() {
  clearTimeout(retry);
  if (asking) return;
  asking = true;
  for (let question = next(); question; question = next()) {
    const { document, shapes, ...compared } = question;
    try {
      const { goals, shapes: found } = await measure(taskOf(document), shapes);
      state.measured = { ...compared, document, rows: goals.map(({ entry }) => entry), shapes: found, problem: null };
    } catch (problem) {
      const { rows, shapes: found } = state.measured ?? {};
      state.measured = { ...compared, document, rows, shapes: found, problem };
      if (problem.offline || problem.status === 429 || problem.status >= 500) {
        state.measured = { ...state.measured, result: null }; // to be asked again
        retry = setTimeout(ask, AGAIN);
        break;
      }
      state.measured = { ...compared, document, rows: null, shapes: null, problem };
    }
  }
  asking = false;
}

/** Return what is to be asked now, or null. */
function next() {
  const { document, answer, preview, measured, tab } = state;
  if (tab !== "goals" || !isMeasured(document) || document.goals.length === 0) return null;
  if (!answer || answer.document.grid !== document.grid) return null; // its answer leads back here
  const other = preview?.result?.ok === false ? null : preview?.result ?? null;
  const known = isFresh(measured) && (other === null || measured.other === other);
  if (known) return null;
  const shapes = [answer.result, ...(other ? [other] : [])].map(shapeOf);
  return { document, result: answer.result, other, shapes };
}

/** Return the corners of the joints and of the beams' sections of a result in the last frame. */
function shapeOf({ joints, beams, jointCount, beamCount }) {
  const last = (numbers, size) => numbers.subarray(LAST * size, (LAST + 1) * size);
  const points = (numbers) => grouped([...numbers], 3);
  return {
    joints: grouped(points(last(joints, 24 * jointCount)), 8),
    beams: grouped(grouped(points(last(beams, 36 * beamCount)), 4), 3),
  };
}

function grouped(list, size) {
  return Array.from({ length: list.length / size }, (_, k) => list.slice(k * size, (k + 1) * size));
}
