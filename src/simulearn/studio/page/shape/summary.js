// What the shown shape does, in words, over the canvas; and what it is where it is not the current one.

import { h } from "/libraries/vue.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { number, summaryOf } from "./words.js";

export const Summary = {
  props: { result: Object, label: String, late: Boolean, invalid: Boolean },
  render() {
    const { result, label, late, invalid } = this;
    if (!result) return null;
    const { title, size, near, notes } = summaryOf(result);
    const time = label || !state.answer ? ""
      : t("shape.milliseconds", { ms: number(state.answer.milliseconds, 0) });
    return h("div", { class: "shape-summary" }, [
      label && h("p", { class: "shape-label" }, label),
      h("p", { class: "shape-title" }, [
        title,
        invalid ? h("span", { class: "shape-state invalid" }, t("shape.lastValid"))
          : late && h("span", { class: "shape-state" }, t("shape.updating")),
      ]),
      h("p", { class: "shape-size" }, size),
      ...notes.map(({ kind, text }) => h("p", { key: text, class: ["shape-note", kind] }, text)),
      (near || time) && h("p", { class: "shape-near" }, [near, time].filter(Boolean).join(" · ")),
    ]);
  },
};
