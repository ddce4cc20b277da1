// The plan: the flat grid seen from above, where it is drawn and changed.

import { h } from "/libraries/vue.js";
import { state } from "../store.js";

export const Plan = {
  render: () => h("section", { class: "plan", "aria-label": "Plan" }, `${state.document.grid.beams.length} beams`),
};
