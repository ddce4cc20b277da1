// Drawings of other programs that became the document: how each was read, and reading it in another
// way. The file stays in the page's memory as long as its document is within reach of undo.

import { ref } from "/libraries/vue.js";
import { readGrid, sameGrid, withGrid } from "../document/document.js";
import { allMends } from "../document/imported.js";
import { edit, select, state, view } from "../store.js";
import { t } from "../text/text.js";
import { openFile } from "./api.js";

const phone = globalThis.matchMedia("(max-width: 599px)"); // as in panels/media.js
const known = new WeakMap(); // grid -> what is told of the drawing that it came from
const changes = ref(0); // in `known`
let numbers = 0;

/** Whether a drawing is being read in another way. */
export const rereading = ref(false);

/** Return how a document came out of a drawing; null where it did not, or was worked on since.
 *
 * { file, options, format, unit, layers, mends, messages, number }: number is that of the drawing.
 */
export function drawingOf(document) {
  const found = changes.value >= 0 ? known.get(document.grid) : null; // asks for `changes`, which is watched
  return found && document.goals.length === 0 ? found : null;
}

/** Show what is to be told of the drawing that has become the document: `found` is the server's answer. */
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

function remember(file, options, found, before = null) {
  const { drawing, messages } = found;
  const mends = allMends(before?.mends ?? [], drawing.mends, options.without ?? []);
  const number = before?.number ?? (numbers += 1);
  known.set(state.document.grid, { file, options, ...drawing, mends, messages, number });
  changes.value += 1;
}

/** Read the document's drawing with other options; several changes in a row are one step of undo.
 *
 * Return the Problem where it cannot be read so; the document then stays.
 */
export async function readAgain(change) {
  const { grid } = state.document;
  const before = known.get(grid);
  if (!before || rereading.value) return null;
  const options = { ...before.options, ...change };
  rereading.value = true;
  try {
    const found = await openFile(before.file, options);
    if (state.document.grid !== grid) return null; // it was changed meanwhile
    const next = { ...readGrid(found.grid), material: grid.material };
    edit((document) => (sameGrid(document.grid, next) ? document : withGrid(document, next)), {
      label: t("drawing.didRead", { file: before.file.name }), merge: `drawing ${before.number}`,
    });
    select({});
    remember(before.file, options, found, before);
    return null;
  } catch (problem) {
    return { ...problem, message: problem.message, options, file: before.file };
  } finally {
    rereading.value = false;
  }
}
