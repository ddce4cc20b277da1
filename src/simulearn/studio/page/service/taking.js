// A design that the server made takes the place of the present one, as one step of undo.

import { edit, state } from "../store.js";
import { withDesign } from "./designs.js";

/** Take a design: {grid, result: its shape or null}, made from `origin`, an earlier document. */
export function takeDesign(origin, { grid, result }, label) {
  edit((document) => withDesign(document, origin, grid), { label });
  // A shape that is known already need not be waited for.
  if (result) state.answer = { document: state.document, result, milliseconds: state.answer?.milliseconds };
}
