// The automatic search: what may change, its progress, what it found and the way there.

import { h, onBeforeUnmount, reactive, ref, watch } from "/libraries/vue.js";
import { withDesign } from "../service/designs.js";
import { mm, number, seconds } from "../service/format.js";
import {
  discardSearch, hideStage, searching, showStage, startSearch, stopSearch,
} from "../service/search.js";
import { edit, notify, select, stale, state, undo } from "../store.js";
import { t } from "../text/text.js";
import { button, iconButton } from "./controls.js";
import { curve } from "./curve.js";
import { NumberField, facts } from "./fields.js";
import { note, problemNote, Reader, sentence, warnings } from "./notes.js";

const LIMIT = 30; // s that a search usually may take
const LEAST = 1; // s
const MOST = 600; // s, as the server

const wishes = reactive({ joints: true, actuators: true, seconds: LIMIT }); // kept while tabs change

function checkbox(label, name, disabled) {
  return h("label", { class: "checkbox" }, [
    h("input", {
      type: "checkbox", checked: wishes[name], disabled,
      onChange: (event) => { wishes[name] = event.target.checked; },
    }), label,
  ]);
}

/** The wishes and the button that begins. */
function form(again) {
  const nothing = !wishes.joints && !wishes.actuators;
  return h("form", { class: "search-form", onSubmit: (event) => event.preventDefault() }, [
    h("fieldset", { class: "free" }, [
      h("legend", t("panels.mayChange")),
      checkbox(t("panels.freeJoints"), "joints"), checkbox(t("panels.freeActuators"), "actuators"),
    ]),
    h(NumberField, {
      label: t("panels.timeLimit"), name: t("panels.timeLimit"), unit: "s", value: wishes.seconds, least: LEAST, most: MOST,
      step: 10, digits: 0, commit: (value) => { wishes.seconds = value; },
    }),
    button(t(again ? "panels.searchAgain" : "panels.searchStart"), () => startSearch(wishes), {
      kind: again ? "" : "primary", disabled: nothing || !state.answer || stale.value || state.document.goals.length === 0,
    }),
    nothing && h("p", { class: "note", role: "status" }, t("panels.nothingFree")),
  ]);
}

function running({ state: now, steps, until, passed, lost }) {
  const last = steps.at(-1);
  const words = { queued: "searchQueued", stopping: "searchStopping" }[now] ?? (last ? "searchRunning" : "searchReady");
  return h("div", { class: "search-running" }, [
    last && h("p", { class: "measure-value numbers" }, mm(last.error_mm)),
    last && h("p", { class: "measure-name" }, t("panels.best")),
    last && curve(steps),
    h("div", {
      class: ["progress", { waiting: !last }], role: "progressbar", "aria-label": t("panels.search"),
      "aria-valuemin": 0, "aria-valuemax": until, "aria-valuenow": last ? Math.min(until, Math.round(passed)) : undefined,
    }, [h("span", { style: { width: `${Math.min(100, (100 * passed) / until)}%` } })]),
    last && h("p", { class: "search-facts numbers" }, [
      h("span", `${number(last.designs)} ${t("panels.designsTried")}`),
      h("span", `${number(passed)} ${t("panels.ofSeconds", { s: `${number(until)} s` })}`),
    ]),
    h("p", { class: "note" }, t(`panels.${words}`)),
    lost && note("warning", t("panels.lost")),
    button(t(last ? "panels.searchStop" : "panels.searchCancel"), stopSearch, { disabled: now === "stopping" }),
  ]);
}

function takeStage(stage) {
  const { search } = state;
  const label = t("panels.didSearch", { mm: mm(stage.error) });
  edit((document) => withDesign(document, search.document, stage.grid), { label });
  if (stage.result)
    state.answer = { document: state.document, result: stage.result, milliseconds: state.answer?.milliseconds };
  select({});
  discardSearch();
  notify(t("panels.tookSearch"), { label: t("panels.undo"), run: undo });
}

/** The card of what a search found, and the slider of its steps. */
const Found = {
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
    const leave = (event) => {
      const box = event.currentTarget;
      const focused = box.contains(event.type === "focusout" ? event.relatedTarget : globalThis.document.activeElement);
      const over = event.type === "focusout" && box.matches(":hover");
      inside.value = focused || over;
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
      return h("div", {
        class: "found", role: "group", "aria-label": t("panels.resultTitle"),
        onPointerenter: enter, onPointerleave: leave, onFocusin: enter, onFocusout: leave,
      }, [
        h("div", { class: "found-measures" }, [
          h("div", [
            h("p", { class: "measure-value numbers" }, best.error_fea_mm === null ? "–" : mm(best.error_fea_mm)),
            h("p", { class: "measure-name" }, best.error_fea_mm === null
              ? `${t("panels.byFea")}: ${t("panels.notChecked")}` : t("panels.byFea")),
          ]),
          h("div", [
            h("p", { class: "measure-value numbers" }, mm(best.error_mm)),
            h("p", { class: "measure-name" }, t("panels.byModel")),
          ]),
        ]),
        curve(history, last ? null : stageOf(at.value).designs),
        all > 1 && steps(),
        facts([
          [t("panels.before"), mm(best.start_mm)],
          best.apart_mm !== null && [t("panels.apart"), mm(best.apart_mm)],
          [t("panels.designs"), `${number(best.designs)}, ${seconds(best.seconds)}`],
        ]),
        !better && note("info", t("panels.notBetter")),
        best.agrees === false && note("warning", t("panels.beyondBound", { mm: mm(best.bound_mm) })),
        best.why_no_fea && note("warning", t("panels.whyNoFea", { why: sentence(best.why_no_fea) })),
        ...warnings(best.warnings),
        h("div", { class: "row" }, [
          button(t(last ? "panels.take" : "panels.takeStep"), () => takeStage(stageOf(at.value)), { kind: "primary" }),
          button(t("panels.discard"), discardSearch),
        ]),
      ]);
    };
  },
};

export const SearchPanel = {
  setup() {
    const Read = Reader(() => {
      const { search } = state;
      return search?.state === "done" ? t("panels.searchDone", { mm: mm(search.best.error_mm) }) : "";
    });
    return () => {
      const { search } = state;
      const changed = search && (search.document.grid !== state.document.grid
        || search.document.goals !== state.document.goals);
      return h("section", { class: "part-section", "aria-label": t("panels.search") }, [
        h("h2", t("panels.search")),
        !search && h("p", { class: "note" }, t("panels.searchNote")),
        changed && ["queued", "running", "stopping", "done"].includes(search.state)
          && note("warning", t("panels.searchEarlier")),
        searching() && running(search),
        search?.state === "done" && h(Found, { key: search.key }),
        search?.state === "failed" && problemNote(t("panels.searchFailed"), search.problem),
        search?.state === "cancelled" && note("info", t("panels.searchEnded")),
        !searching() && form(search !== null),
        h(Read),
      ]);
    };
  },
};
