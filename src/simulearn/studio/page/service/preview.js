// A preview: a suggestion or an earlier step, shown in the scene in place of the answer while the
// pointer or the focus is on it. Any change of the design ends it.

import { watch } from "/libraries/vue.js";
import { state } from "../store.js";

let owner = null; // what the preview is of

/** Show a result in the scene: {result, document, label}. of: any object or text that names it. */
export function showPreview(of, preview) {
  owner = of;
  state.preview = preview;
}

/** Stop showing a preview, if it is still the one of `of`. */
export function endPreview(of) {
  if (owner !== of) return;
  owner = null;
  state.preview = null;
}

watch(() => state.document.grid, () => {
  owner = null;
  state.preview = null;
});
