// The bottom line: whether the grid is valid, what the engine answered, and with which model.

import { h, ref, watch } from "/libraries/vue.js";
import { preparing, stale, state, view } from "../store.js";
import { saveNow, showConflict } from "../service/saving.js";
import { formatNumber } from "../text/numbers.js";
import { t } from "../text/text.js";
import { icon } from "./icons.js";

const QUIET = 800; // ms without a change until a result is read out

/** Return what the last answer says in one sentence, or why there is none. */
function sentence() {
  const errors = state.check?.errors.length ?? 0;
  if (state.document.grid.beams.length === 0) return t("common.empty");
  if (errors) return t(errors === 1 ? "common.errorOne" : "common.errorMany", { n: errors });
  if (!state.answer || stale.value) {
    if (state.connection === "offline") return t("common.noAnswer");
    return t(preparing() ? "common.preparingShort" : "common.updating");
  }
  const { result } = state.answer;
  const size = formatNumber(Math.abs(result.rise_mm), view.language);
  return t(result.rise_mm < 0 ? "common.sinks" : "common.rises", { mm: size });
}

/** Return "valid", "error", "waiting" or "empty". */
function level() {
  if (state.document.grid.beams.length === 0) return "empty";
  if (state.check?.errors.length) return "error";
  return !state.answer || stale.value ? "waiting" : "valid";
}

const GLYPHS = { valid: "check", error: "error", waiting: "clock", empty: "beam" };

/** Return the state of saving in words; where something can be done about it, as a button. */
export function savingState() {
  const text = t(`common.saving_${state.saving}`);
  const run = { failed: saveNow, offline: saveNow, conflict: showConflict }[state.saving];
  if (!run) return h("span", { class: "saving" }, text);
  return h("button", {
    type: "button", class: ["saving", state.saving], onClick: run,
    title: t(`common.savingDo_${state.saving}`),
  }, text);
}

/** Show the errors, wherever the page is. */
function showErrors() {
  view.side = true;
  state.tab = "design";
  const [first] = globalThis.document.querySelectorAll(".problems.error button");
  first?.focus();
}

function main() {
  const content = [icon(GLYPHS[level()], 16), h("span", sentence())];
  if (level() !== "error") return h("span", { class: ["status-main", level()] }, content);
  return h("button", {
    type: "button", class: "status-main error", title: t("common.showErrors"), onClick: showErrors,
  }, content);
}

export const Status = {
  setup() {
    const read = ref("");
    let timer = 0;
    watch([() => state.check, () => state.answer, stale], () => {
      clearTimeout(timer);
      timer = setTimeout(() => { read.value = sentence(); }, QUIET);
    });
    const number = (value, digits) => formatNumber(value, view.language, digits);
    const extra = (text, rest = {}) => h("span", { class: "status-extra", ...rest }, text);
    return () => {
      const result = level() === "valid" ? state.answer.result : null;
      const place = state.pointer && `x ${number(state.pointer[0])}  y ${number(state.pointer[1])} mm`;
      return h("footer", { class: "status" }, [
        main(),
        result && extra(t("common.answered", { ms: number(1000 * result.seconds, 0) })),
        result && (result.bound_mm == null ? extra(t("common.noBound"))
          : extra(t("common.bound", { mm: number(result.bound_mm) }), { title: t("common.boundHint") })),
        h("span", { class: "status-space" }),
        state.connection === "offline" && h("span", { class: "status-offline" }, [
          icon("warning", 16), t("common.offline"),
        ]),
        h("span", { class: "phone-only" }, [savingState()]),
        place && extra(place, { class: "status-extra numbers" }),
        result?.model && extra(t("common.modelName", { name: result.model.name })),
        extra(state.material?.title ?? state.document.grid.material),
        h("span", { class: "hidden", role: "status" }, read.value),
      ]);
    };
  },
};
