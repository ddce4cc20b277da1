// Drawings of other programs that became the document: how each was read, and reading it in another
// way. The file stays in the page's memory as long as its document is within reach of undo.

import { ref } from "/libraries/vue.js";
import { readGrid, sameGrid, withGrid } from "../document/document.js";
import { allMends } from "../document/imported.js";
import { isOfAll } from "../document/surfaces.js";
import { edit, select, state, view } from "../store.js";
import { t } from "../text/text.js";
import { openFile } from "./api.js";

const phone = globalThis.matchMedia("(max-width: 599px)"); // as in panels/media.js
const known = new WeakMap(); // grid -> what is known of the drawing that it came from
const changes = ref(0); // in `known`
let numbers = 0;
let wanted = null; // options for which the drawing is still to be read

/** Whether a drawing is being read in another way. */
export const rereading = ref(false);

/** How often a drawing could not be read in another way: what was switched then goes back. */
export const refusals = ref(0);

/** Return how a document came out of a drawing; null where it did not, or was worked on since.
 *
 * { file, options, format, unit, layers, mends, messages, number }: number is that of the drawing.
 */
export function drawingOf(document) {
  const found = changes.value >= 0 ? known.get(document.grid) : null; // asks for `changes`, which is watched
  return found && document.goals.every(isOfAll) ? found : null;
}

/** Show the report of the drawing that has become the document: `found` is the server's answer. */
export function showDrawing(file, options, found) {
  remember(file, options, found);
  Object.assign(state, { tab: "design", drawingShown: true });
  view.side = true;
  showPlan();
}

/** Show the plan where there is room for one view only, or it is not shown. */
export function showPlan() {
  if (view.pane === "shape" || phone.matches) view.pane = "plan";
}

/** Read the document's drawing again; changes in a row are one step of undo, and only the last is read.
 *
 * change(options): the options in place of those so far. Return { problem, file, options } where the
 * drawing cannot be read so; the document then stays.
 */
export async function readAgain(change) {
  const drawing = known.get(state.document.grid);
  if (!drawing) return null;
  wanted = change(wanted ?? drawing.options);
  if (rereading.value) return null;
  rereading.value = true;
  let refusal = null;
  while (wanted) {
    const options = wanted;
    wanted = null;
    try {
      const found = await openFile(drawing.file, options);
      if (wanted) continue;
      if (known.get(state.document.grid)?.number !== drawing.number) break; // another one was opened
      take(drawing.file, options, found);
    } catch (problem) {
      if (!wanted) refusal = { problem, file: drawing.file, options };
    }
  }
  rereading.value = false;
  if (refusal) refusals.value += 1;
  return refusal;
}

function take(file, options, found) {
  const before = known.get(state.document.grid);
  const { material } = state.document.grid;
  const next = { ...readGrid(found.grid), material };
  edit((document) => (sameGrid(document.grid, next) ? document : withGrid(document, next)), {
    label: t("drawing.didRead", { file: file.name }), merge: `drawing ${before.number}`,
  });
  select({});
  remember(file, options, found, before);
}

function remember(file, options, found, before = null) {
  const { drawing, messages } = found;
  const alike = before?.unit.mm === drawing.unit.mm; // else the places of before are elsewhere
  const earlier = (before?.mends ?? []).map((mend) => (alike ? mend : { ...mend, places: [] }));
  const mends = allMends(earlier, drawing.mends, options.without ?? []);
  const number = before?.number ?? (numbers += 1);
  known.set(state.document.grid, { file, options, ...drawing, mends, messages, number });
  changes.value += 1;
}
