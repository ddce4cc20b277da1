// The tool Fix: a click on a joint makes it the one that stays in place.

import { setFixed } from "../../document/edit.js";
import { nearestJoint } from "../../document/measure.js";
import { edit, state } from "../../store.js";
import { t } from "../../text/text.js";
import { announce, clearMarks, reach } from "../editor.js";

export const fix = {
  hover(pointer) {
    const k = jointUnder(pointer);
    state.hover = k === null ? null : { joint: k };
  },

  press: (pointer) => fix.hover(pointer),
  drag: (pointer) => fix.hover(pointer),

  release(pointer) {
    const k = jointUnder(pointer);
    if (k === null) return;
    fixJoint(k);
    state.tool = "select";
  },

  leave() {
    state.hover = null;
  },

  key({ key }) {
    if (key !== "Escape") return false;
    state.tool = "select";
    return true;
  },

  cancel: clearMarks,
};

/** Fix joint k in place of the present one. */
export function fixJoint(k) {
  edit((document) => setFixed(document, k), { label: t("plan.editFix") });
  announce(t("plan.saidFixed", { joint: k }));
}

/** Joints are hit from further away than with other tools: there is nothing else to hit. */
function jointUnder({ point, touch }) {
  const near = nearestJoint(state.document.grid, point);
  return near && near.distance <= 2 * reach(touch) ? near.number : null;
}
