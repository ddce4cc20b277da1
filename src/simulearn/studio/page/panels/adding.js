// Adding a goal: a point is picked in the shape, or chosen from a list.

import { h, nextTick, onBeforeUnmount, ref } from "/libraries/vue.js";
import { addGoal, goalOf, vertexPoint } from "../document/goals.js";
import { chooseSurface } from "../service/files.js";
import { edit, select, stale, state, view } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { vertexWords } from "./vertices.js";

const DIGITS = 2; // of a target, mm

/** Return the result of the current design, or null while there is none. */
const current = () => (stale.value ? null : state.answer?.result ?? null);

const rounded = (point) => point.map((x) => Number(x.toFixed(DIGITS)));

/** Add a goal at the present place of a vertex, and select it. */
function add(vertex) {
  const point = current() && vertexPoint(current(), vertex);
  if (!point) return;
  if (goalOf(state.document, vertex) === null)
    edit((document) => addGoal(document, vertex, rounded(point)), {
      label: t("panels.didAddGoal", { name: vertexWords(vertex) }),
    });
  select({ goal: goalOf(state.document, vertex) });
}

/** The button that waits for a point to be picked in the shape, and a choice for keyboards. */
export const Adding = {
  setup() {
    const chosen = ref("");
    const stop = () => { state.pickVertex = null; };
    const key = (event) => {
      if (event.key !== "Escape" || !state.pickVertex) return;
      event.preventDefault();
      stop();
    };
    globalThis.addEventListener("keydown", key);
    onBeforeUnmount(() => {
      globalThis.removeEventListener("keydown", key);
      stop();
    });
    const pick = () => {
      if (state.pickVertex) return stop();
      if (view.pane === "plan") view.pane = "shape"; // the shape has to be seen to pick in it
      state.pickVertex = (vertex) => {
        if (!current()) return; // the shape is of an earlier design: it is picked again in a moment
        stop();
        add(vertex);
      };
    };
    const points = () => {
      const { grid, goals } = state.document;
      const free = (vertex) => goals.length === 0 || goalOf(state.document, vertex) === null;
      const option = (vertex) => h("option", { value: JSON.stringify(vertex) }, vertexWords(vertex));
      const joints = grid.joints.map((_, k) => ["joint", k, "centre"])
        .filter((vertex) => vertex[1] !== grid.fixed && free(vertex));
      const beams = grid.beams.map((_, b) => ["beam", b, "middle", "centre"]).filter(free);
      return [
        h("option", { value: "" }, t("panels.choosePoint")),
        h("optgroup", { label: t("panels.joints") }, joints.map(option)),
        h("optgroup", { label: t("panels.beams") }, beams.map(option)),
      ];
    };
    const addChosen = async (event) => {
      event.preventDefault();
      if (chosen.value) add(JSON.parse(chosen.value));
      chosen.value = "";
      await nextTick(); // who uses the keyboard goes on with the target
      globalThis.document.querySelector(".goal.selected input")?.focus();
    };
    return () => {
      const picking = Boolean(state.pickVertex);
      const ready = current() !== null;
      return h("div", { class: "adding" }, [
        button(picking ? t("panels.pickCancel") : t("panels.pick"), pick, {
          glyph: picking ? "close" : "target", kind: picking || state.document.goals.length ? "" : "primary",
          disabled: !ready && !picking,
        }),
        button(t("surface.open"), chooseSurface, { glyph: "surface", title: t("surface.openHint") }),
        picking && h("p", { class: "picking", role: "status" }, t("panels.picking")),
        h("form", { class: "adding-list", onSubmit: addChosen }, [
          h("select", {
            class: "select", "aria-label": t("panels.addFrom"), value: chosen.value, disabled: !ready,
            onChange: (event) => { chosen.value = event.target.value; },
          }, points()),
          h("button", {
            type: "submit", class: "button", disabled: !chosen.value || !ready,
          }, t("panels.add")),
        ]),
        !current() && !state.answer && h("p", { class: "note" }, t("panels.addLater")),
      ]);
    };
  },
};
