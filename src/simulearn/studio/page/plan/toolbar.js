// The buttons over the plan: tools and actions on the left, zoom below on the right.

import { h } from "/libraries/vue.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import {
  duplicateSelection, fitAll, hasSelection, mirrorSelection, removeSelection, rotateSelection, useTool, zoom,
} from "./actions.js";
import { icon } from "./icons.js";

const TOOLS = [["select", "V"], ["draw", "D"], ["split", "S"], ["fix", "X"]];

export const Toolbar = {
  render() {
    const some = hasSelection();
    const empty = state.document.grid.joints.length === 0;
    return h("div", { class: "plan-toolbar", role: "group", "aria-label": t("plan.tools") }, [
      h("div", TOOLS.map(([name, key]) =>
        button(name, name, key, () => useTool(name), { "aria-pressed": state.tool === name }))),
      h("div", [
        button("delete", "delete", "Del", removeSelection, { disabled: !some }),
        button("duplicate", "duplicate", "Ctrl D", duplicateSelection, { disabled: !some }),
        button("mirrorX", "mirrorX", "M", () => mirrorSelection("x"), { disabled: empty }),
        button("mirrorY", "mirrorY", "Shift M", () => mirrorSelection("y"), { disabled: empty }),
        button("rotate", "rotate", "R", () => rotateSelection(90), { disabled: empty }),
      ]),
    ]);
  },
};

export const Zooms = {
  render: () => h("div", { class: "plan-zooms", role: "group", "aria-label": t("plan.zooms") }, [
    button("zoomOut", "minus", "", () => zoom(-1)),
    button("zoomIn", "plus", "", () => zoom(1)),
    button("fit", "fit", "F", fitAll),
  ]),
};

function button(name, shape, key, onClick, more = {}) {
  const label = t(`plan.${name}`);
  return h("button", {
    type: "button", class: "plan-button", "aria-label": label, title: key ? `${label} (${key})` : label,
    onClick, ...more,
  }, icon(shape));
}
