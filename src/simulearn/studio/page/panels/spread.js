// How prints of the design differ: in numbers, and as lines around the shape.

import { h } from "/libraries/vue.js";
import { mm, number } from "../service/format.js";
import { askSpread, dropSpread, freshSpread } from "../service/spread.js";
import { stale, state } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { facts } from "./fields.js";
import { note, problemNote } from "./notes.js";

/** Return the joint whose height differs the most from print to print, [number in the design, its spread]. */
function widest({ scatter: { joints }, joint_numbers: numbers }) {
  const range = ({ up_90_mm: [low, high] }) => high - low;
  const k = joints.reduce((best, one, at) => (range(one) > range(joints[best]) ? at : best), 0);
  return [numbers[k], joints[k]];
}

function found(result) {
  const { scatter } = result;
  const [k, { up_90_mm: [low, high] }] = widest(result);
  return [
    facts([
      [t("panels.spreadOverall"), `${mm(scatter.overall_mm)} (${number(scatter.overall_percent, 1)} %)`],
      [t("panels.spreadWidest", { k }), t("panels.spreadRange", { low: mm(low), high: mm(high) })],
      [t("panels.spreadPrints"), number(scatter.prints)],
    ]),
    scatter.groups.length > 1 && note("warning", t("panels.spreadGroups", {
      count: scatter.groups.length, sizes: scatter.groups.join(" + "),
    })),
    scatter.beyond > 0 && note("info", t("panels.spreadBeyond", { count: number(scatter.beyond) })),
    h("p", { class: "note" }, t("panels.spreadNote")),
  ];
}

export const Spread = {
  render() {
    const { spread, material } = state;
    const known = material && (material.scatter.print > 0 || material.scatter.beam > 0);
    const result = freshSpread();
    const earlier = spread?.state === "ready" && !result;
    const ready = known && state.answer && !stale.value && spread?.state !== "asking";
    return h("section", { class: "part-section", "aria-label": t("panels.spread") }, [
      h("h2", t("panels.spread")),
      material && !known && h("p", { class: "note" }, t("panels.spreadUnknown")),
      known && h("div", { class: "row" }, [
        !result && button(t("panels.spreadShow"), askSpread, { disabled: !ready }),
        spread && button(t("panels.spreadHide"), dropSpread),
      ]),
      spread?.state === "asking" && h("p", { class: "note", role: "status" }, t("panels.spreadAsking")),
      earlier && note("info", t("panels.spreadEarlier")),
      spread?.state === "failed" && (spread.problem ? problemNote(t("panels.spreadFailed"), spread.problem)
        : note("error", t("panels.spreadFailed"), [h("p", spread.result?.message)])),
      ...(result ? found(result) : []),
    ]);
  },
};
