// The tab "Design": what is selected, what warns, and every part in a list; or how the document came out
// of a drawing.

import { h } from "/libraries/vue.js";
import { drawingOf, refusals } from "../service/drawings.js";
import { state } from "../store.js";
import { DrawingPanel, drawingButton } from "./drawing.js";
import { Inspector } from "./inspector.js";
import { Outline } from "./outline.js";
import { Warnings } from "./problems.js";

export const Design = {
  render() {
    const drawing = state.drawingShown ? drawingOf(state.document) : null;
    if (drawing) return h(DrawingPanel, { drawing, key: refusals.value });
    return h("div", { class: "design" }, [
      h("div", { class: "design-top" }, [drawingButton(), h(Inspector)]), h(Warnings), h(Outline),
    ]);
  },
};
