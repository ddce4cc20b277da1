// The bottom line: whether the grid is valid, what the engine answered, and with which model.

import { h, ref, watch } from "/libraries/vue.js";
import { stale, state, view } from "../store.js";
import { formatNumber } from "../text/numbers.js";
import { t } from "../text/text.js";
import { icon } from "./icons.js";

const QUIET = 800; // ms without a change until a result is read out

/** Return what the last answer says in one sentence, or why there is none. */
function sentence() {
  const errors = state.check?.errors.length ?? 0;
  if (state.document.grid.beams.length === 0) return t("common.empty");
  if (errors) return t(errors === 1 ? "common.errorOne" : "common.errorMany", { n: errors });
  if (!state.answer || stale.value) return t("common.updating");
  const { result } = state.answer;
  return t("common.rises", { rise: formatNumber(result.rise_mm, view.language) });
}

export const Status = {
  setup() {
    const read = ref("");
    let timer = 0;
    watch([() => state.check, () => state.answer, stale], () => {
      clearTimeout(timer);
      timer = setTimeout(() => { read.value = sentence(); }, QUIET);
    });
    return () => {
      const errors = state.check?.errors.length ?? 0;
      const result = state.answer?.result;
      const number = (value, digits) => formatNumber(value, view.language, digits);
      return h("footer", { class: "status" }, [
        h("span", { class: ["status-main", errors ? "error" : ""] }, [
          icon(errors ? "error" : "check", 16), sentence(),
        ]),
        result && h("span", { class: "status-extra" }, t("common.answered", {
          ms: number(state.answer.milliseconds, 0),
        })),
        result && result.bound_mm != null
          && h("span", { class: "status-extra" }, t("common.bound", { mm: number(result.bound_mm) })),
        h("span", { class: "status-space" }),
        state.pointer && h("span", { class: "status-extra numbers" },
          `${number(state.pointer[0])}  ${number(state.pointer[1])} mm`),
        result?.material && h("span", { class: "status-extra" }, result.material.name),
        state.connection === "offline" && h("span", { class: "warning" }, t("common.offline")),
        h("span", { class: "hidden", role: "status" }, read.value),
      ]);
    };
  },
};
