// How far the shown shape is from its goals: computed here where they are points, else as the server has
// answered; see service/measuring.js.

import { goalErrors } from "../document/goals.js";
import { isPoint, sameWishes, verticesOf } from "../document/kinds.js";
import { state } from "../store.js";

/** Return whether the server has to compare a document's shape with its goals. */
export function isMeasured({ goals, pose }) {
  return pose === "free" || !goals.every(isPoint);
}

/** Return what is known of the shown design's goals:
 *
 * { each: [{ mean, worst: mm, vertex: the worst's or null } or null], mean, then: mm of the preview,
 *   problem, fresh }.
 */
export function goalFacts() {
  const { document, answer, preview } = state;
  const nothing = { each: document.goals.map(() => null), mean: null, then: null, problem: null, fresh: true };
  if (!isMeasured(document)) {
    if (!answer) return nothing;
    const { each, mean } = goalErrors(answer.result, document.goals);
    const then = preview?.result ? goalErrors(preview.result, document.goals).mean : null;
    return { ...nothing, each: each.map((mm, k) => pointFacts(mm, document.goals[k])), mean, then };
  }
  const { measured } = state;
  const fresh = isFresh(measured);
  const known = measured?.rows && measured.document.goals.length === document.goals.length;
  if (!known) return { ...nothing, problem: fresh ? measured.problem : null, fresh };
  const [now, then] = measured.shapes;
  const seen = preview?.result && measured.other === preview.result;
  const each = document.goals.map((_, k) => entryFacts(measured, k));
  return { ...nothing, each, mean: now.error_mm, then: seen ? then.error_mm : null, fresh };
}

function pointFacts(mm, { vertex }) {
  return mm === null ? null : { mean: mm, worst: mm, vertex };
}

function entryFacts({ document, rows, shapes: [{ distances_mm: distances }] }, k) {
  const own = distances.filter((_, row) => rows[row] === k);
  if (own.length === 0) return null;
  const worst = Math.max(...own);
  const vertex = verticesOf(document.goals[k], document.grid)[own.indexOf(worst)] ?? null;
  return { mean: own.reduce((sum, mm) => sum + mm, 0) / own.length, worst, vertex: own.length > 1 ? vertex : null };
}

/** Return the comparison of a result that is shown, perhaps of an earlier moment; null where none is known. */
export function comparisonOf(result) {
  const { measured, document } = state;
  if (!measured?.shapes || !isMeasured(document) || measured.document.pose !== document.pose) return null;
  const [now, then] = measured.shapes;
  return (result === measured.other && then) || now;
}

/** Return lines [[from, to]] from the parts of a shown result to where they should be; [] until they are known. */
export function linesOf(result) {
  const { measured, document } = state;
  if (!measured?.shapes || !isMeasured(document) || !sameWishes(measured.document, document)) return [];
  const k = [measured.result, measured.other].indexOf(result);
  return k < 0 ? [] : measured.shapes[k].lines;
}

/** Return whether a comparison is of the current goals and shape. */
export function isFresh(measured) {
  return Boolean(measured) && measured.result === state.answer?.result && sameWishes(measured.document, state.document);
}
