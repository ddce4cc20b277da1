// The automatic search: what may change, and its progress.

import { h, reactive } from "/libraries/vue.js";
import { sameWishes } from "../document/kinds.js";
import { mm, number } from "../service/format.js";
import { searching, startSearch, stopSearch, timesAsLong } from "../service/search.js";
import { ANSWERS as OTHERS, ofBest } from "../service/steps.js";
import { stale, state } from "../store.js";
import { t } from "../text/text.js";
import { Answers } from "./answers.js";
import { button } from "./controls.js";
import { curve } from "./curve.js";
import { NumberField } from "./fields.js";
import { Found } from "./found.js";
import { note, problemNote, Reader, reasonOf } from "./notes.js";

const LIMIT = 30; // s that a search usually may take
const LEAST = 1; // s
const MOST = 600; // s, as the server
const ANSWERS = 10; // that can be wanted here

const wishes = reactive({ joints: true, actuators: true, seconds: LIMIT, answers: 1 }); // kept while tabs change

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
      label: t("panels.timeLimit"), name: t("panels.timeLimit"), unit: "s", value: wishes.seconds,
      least: LEAST, most: MOST / timesAsLong(wishes.answers), step: 10, digits: 0, commit: (value) => { wishes.seconds = value; },
    }),
    h("p", { class: "note answers-note" }, wishes.answers > 1 ? t("panels.answersNote") : ""),
    h(NumberField, {
      label: t("panels.answersWanted"), name: t("panels.answersWanted"), value: wishes.answers,
      least: 1, most: ANSWERS, step: 1, digits: 0,
      commit: (value) => {
        wishes.answers = Math.round(value);
        wishes.seconds = Math.min(wishes.seconds, MOST / timesAsLong(wishes.answers));
      },
    }),
    button(t(again ? "panels.searchAgain" : "panels.searchStart"), () => startSearch(wishes), {
      kind: again ? "" : "primary",
      disabled: nothing || !state.answer || stale.value || state.document.goals.length === 0,
    }),
    nothing && h("p", { class: "note", role: "status" }, t("panels.nothingFree")),
  ]);
}

function running({ state: now, steps, until, passed, lost }) {
  const last = ofBest(steps).at(-1);
  const others = steps.at(-1)?.phase === OTHERS;
  const words = { queued: "searchQueued", stopping: "searchStopping" }[now]
    ?? (others ? "searchOthers" : last ? "searchRunning" : "searchReady");
  return h("div", { class: "search-running" }, [
    last && h("p", { class: "measure-value numbers" }, mm(last.error_mm)),
    last && h("p", { class: "measure-name" }, t("panels.best")),
    last && curve(steps),
    h("div", {
      class: ["progress", { waiting: !last }], role: "progressbar", "aria-label": t("panels.search"),
      "aria-valuemin": 0, "aria-valuemax": until,
      "aria-valuenow": last ? Math.min(until, Math.round(passed)) : undefined,
    }, [h("span", { style: { width: `${Math.min(100, (100 * passed) / until)}%` } })]),
    last && h("p", { class: "search-facts numbers" }, [
      h("span", `${number(steps.at(-1).designs)} ${t("panels.designsTried")}`),
      h("span", `${number(passed)} ${t("panels.ofSeconds", { s: `${number(until)} s` })}`),
    ]),
    h("p", { class: "note" }, t(`panels.${words}`)),
    lost && note("warning", t("panels.lost")),
    button(t(last ? "panels.searchStop" : "panels.searchCancel"), stopSearch, {
      disabled: now === "stopping",
    }),
  ]);
}

export const SearchPanel = {
  setup() {
    const Read = Reader(() => {
      const { search } = state;
      return search?.state === "done" ? t("panels.searchDone", { mm: mm(search.best.error_mm) }) : "";
    });
    return () => {
      const { search } = state;
      const changed = search && (search.document.grid !== state.document.grid
        || !sameWishes(search.document, state.document));
      return h("section", { class: "part-section", "aria-label": t("panels.search") }, [
        h("h2", t("panels.search")),
        !search && h("p", { class: "note" }, t("panels.searchNote")),
        changed && ["queued", "running", "stopping", "done"].includes(search.state)
          && note("warning", t("panels.searchEarlier")),
        searching() && running(search),
        search?.state === "done" && search.problem && note("warning", reasonOf(search.problem)),
        search?.state === "done" && h(Found, { key: search.key }),
        search?.answers?.length > 1 && h(Answers),
        search?.state === "failed" && problemNote(t("panels.searchFailed"), search.problem),
        search?.state === "cancelled" && note("info", t("panels.searchEnded")),
        !searching() && form(search !== null),
        h(Read),
      ]);
    };
  },
};
