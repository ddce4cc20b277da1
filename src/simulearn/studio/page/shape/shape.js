// The shape: the morphing grid in space, frame by frame.

import { h } from "/libraries/vue.js";
import { state } from "../store.js";

export const Shape = {
  render: () => h("section", { class: "shape", "aria-label": "Shape" }, state.answer ? `${state.answer.result.rise_mm} mm` : "…"),
};
