// What a search found and the designs on the way there, each shown in the scene and taken by a button.

import { h, onBeforeUnmount, ref, watch } from "/libraries/vue.js";
import { mm, number, percent, seconds } from "../service/format.js";
import { discardSearch, hideStage, showStage } from "../service/search.js";
import { takeDesign } from "../service/taking.js";
import { notify, select, state, undo } from "../store.js";
import { t } from "../text/text.js";
import { button, iconButton } from "./controls.js";
import { curve } from "./curve.js";
import { facts } from "./fields.js";
import { note, sentence, warnings } from "./notes.js";

/** Take a design of the search, which is forgotten then: a stage, or one of several answers. */
export function takeStage(stage) {
  takeDesign(state.search.document, stage, t("panels.didSearch", { mm: mm(stage.error) }));
  select({});
  discardSearch();
  notify(t("panels.tookSearch"), { label: t("panels.undo"), run: undo });
}

/** After the card is gone the focus goes on to what begins a search. */
function refocus({ currentTarget, target }) {
  if (!target.closest("button")) return;
  const section = currentTarget.closest("section");
  setTimeout(() => section.querySelector(".search-form > .button")?.focus());
}

function measure(error, name) {
  return h("div", [
    h("p", { class: "measure-value numbers" }, mm(error)),
    h("p", { class: "measure-name" }, t(`panels.${name}`)),
  ]);
}

/** The card of what a search found, and the slider of its steps. */
export const Found = {
  setup() {
    const at = ref(state.search.stages.length); // 1 to the number of stages
    const inside = ref(false); // whether pointer or focus is on the card
    const stageOf = (n) => state.search.stages[n - 1];
    const show = () => {
      const all = state.search.stages.length;
      const label = at.value === all ? t("panels.bestLabel") : t("panels.stepLabel", { n: at.value, all });
      showStage(stageOf(at.value), label);
    };
    watch([at, inside], () => (inside.value ? show() : hideStage()));
    onBeforeUnmount(hideStage);
    const enter = () => { inside.value = true; };
    const leave = ({ type, currentTarget: box, relatedTarget }) => {
      const blurred = type === "focusout";
      const focused = box.contains(blurred ? relatedTarget : globalThis.document.activeElement);
      inside.value = focused || (blurred && box.matches(":hover"));
    };
    const steps = () => {
      const all = state.search.stages.length;
      const to = (n) => { at.value = Math.min(all, Math.max(1, n)); };
      const value = t("panels.stepValue", { n: at.value, all, mm: mm(stageOf(at.value).error) });
      return h("div", { class: "steps" }, [
        h("div", { class: "steps-row" }, [
          iconButton("chevron", t("panels.stepBack"), () => to(at.value - 1),
            { class: "icon-button small turn-left", disabled: at.value === 1 }),
          h("input", {
            type: "range", min: 1, max: all, step: 1, value: at.value,
            "aria-label": t("panels.steps"), "aria-valuetext": value,
            onInput: (event) => to(Number(event.target.value)),
          }),
          iconButton("chevron", t("panels.stepOn"), () => to(at.value + 1),
            { class: "icon-button small turn-right", disabled: at.value === all }),
        ]),
        h("p", { class: "note numbers" }, value),
      ]);
    };
    return () => {
      const { best, steps: history, stages } = state.search;
      const all = stages.length;
      const last = at.value === all;
      const better = best.error_mm < best.start_mm;
      const checked = best.error_fea_mm !== null;
      return h("div", {
        class: "found", role: "group", "aria-label": t("panels.resultTitle"),
        onPointermove: enter, onPointerleave: leave, onFocusin: enter, onFocusout: leave,
      }, [
        h("div", { class: "found-measures" }, checked
          ? [measure(best.error_fea_mm, "byFea"), measure(best.error_mm, "byModel")]
          : [measure(best.error_mm, "byModel"), h("p", { class: "note" }, t("panels.notChecked"))]),
        curve(history, last ? null : stageOf(at.value).designs),
        all > 1 && steps(),
        facts([
          [t("panels.before"), mm(best.start_mm)],
          best.apart_mm !== null && [t("panels.apart"), mm(best.apart_mm)],
          typeof best.probability?.together === "number" && [t("surface.prints"), percent(best.probability.together)],
          [t("panels.designs"), `${number(best.designs)}, ${seconds(best.seconds)}`],
        ]),
        !better && note("info", t("panels.notBetter")),
        best.agrees === false && note("warning", t("panels.beyondBound", { mm: mm(best.bound_mm) })),
        best.why_no_fea && note("warning", t("panels.whyNoFea", { why: sentence(best.why_no_fea) })),
        ...warnings(best.warnings),
        h("div", { class: "row", onClickCapture: refocus }, [
          button(t(last ? "panels.take" : "panels.takeStep"), () => takeStage(stageOf(at.value)), {
            kind: "primary",
          }),
          button(t("panels.discard"), discardSearch),
        ]),
      ]);
    };
  },
};
