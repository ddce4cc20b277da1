// The goals of a document: how far each is missed, its target and weight.

import { computed, h, nextTick } from "/libraries/vue.js";
import { goalErrors, moveGoal, removeGoal, setWeight } from "../document/goals.js";
import { mm } from "../service/format.js";
import { edit, endMerge, select, stale, state } from "../store.js";
import { t } from "../text/text.js";
import { Adding } from "./adding.js";
import { iconButton } from "./controls.js";
import { NumberField } from "./fields.js";
import { icon } from "./icons.js";
import { note, Reader } from "./notes.js";
import { vertexWords } from "./vertices.js";

const AXES = ["x", "y", "z"];
const DIGITS = 2; // of a target, mm
const MOST_WEIGHT = 1000; // only the ratios of weights count

function goal({ vertex, target, weight }, k, error) {
  const name = vertexWords(vertex);
  const selected = state.selection.goal === k;
  const change = (apply, label, merge) => {
    edit(apply, { label, merge });
    if (!merge) endMerge();
  };
  const hover = () => { state.hover = { goal: k }; };
  const leave = () => { state.hover = null; };
  return h("li", {
    key: vertex.join(), class: ["goal", { selected, hovered: state.hover?.goal === k }],
    onPointerenter: hover, onPointerleave: leave, onFocusin: () => {
      hover();
      if (!selected) select({ goal: k });
    }, onFocusout: leave,
  }, [
    h("div", { class: "goal-head" }, [
      h("button", {
        type: "button", class: "goal-name", "aria-pressed": String(selected),
        "aria-label": error === null ? t("panels.selectGoal", { name })
          : t("panels.goalFacts", { name, mm: mm(error) }),
        onClick: () => select({ goal: k }),
      }, [h("span", { class: "goal-mark", "aria-hidden": "true" }), h("span", name)]),
      h("span", { class: ["goal-error numbers", { old: stale.value }] }, error === null ? "–" : mm(error)),
      iconButton("trash", t("panels.removeGoal", { name }), async (event) => {
        const list = event.currentTarget.closest("ol");
        edit((document) => removeGoal(document, k), { label: t("panels.didRemoveGoal", { name }) });
        select({});
        await nextTick(); // the focus goes on to the goal that took its place
        [...list.querySelectorAll(".goal-name")].slice(0, k + 1).at(-1)?.focus();
      }, { class: "icon-button small" }),
    ]),
    h("div", { class: "goal-fields" }, [
      ...AXES.map((axis, i) => h(NumberField, {
        key: axis, label: axis, name: t("panels.targetOf", { axis, name }), value: target[i], digits: DIGITS,
        merge: `target ${vertex.join()} ${axis}`,
        commit: (value, merge) => change((document) => moveGoal(document, k,
          target.map((x, n) => (n === i ? value : x))), t("panels.didMoveGoal", { name }), merge),
      })),
      h(NumberField, {
        key: "weight", label: t("panels.weight"), name: t("panels.weightOf", { name }), value: weight,
        least: 0, most: MOST_WEIGHT, digits: DIGITS, merge: `weight ${vertex.join()}`,
        commit: (value, merge) => change((document) => setWeight(document, k, value),
          t("panels.didWeight", { name }), merge),
      }),
    ]),
  ]);
}

export const GoalList = {
  setup() {
    // While a design is simulated anew, the errors of the one before stay, dimmed.
    const errors = computed(() => {
      const { goals } = state.document;
      if (!state.answer) return { each: goals.map(() => null), mean: null };
      return goalErrors(state.answer.result, goals);
    });
    const previewed = computed(() => (
      state.preview?.result ? goalErrors(state.preview.result, state.document.goals).mean : null
    ));
    const Read = Reader(() => {
      const { mean } = errors.value;
      return mean === null ? "" : t("panels.errorRead", { mm: mm(mean) });
    });
    const head = () => {
      const { each, mean } = errors.value;
      const { goals } = state.document;
      const known = each.filter((error) => error !== null);
      const most = Math.max(...known);
      const far = each.indexOf(most);
      const then = previewed.value;
      return h("div", { class: ["measure", { old: stale.value }] }, [
        h("p", { class: "measure-value numbers" }, [
          mean === null ? "–" : mm(mean),
          then !== null && mean !== null && h("span", {
            class: ["measure-then", then < mean ? "better" : "worse"],
          }, [h("span", { "aria-hidden": "true" }, " → "), mm(then)]),
        ]),
        h("p", { class: "measure-name" }, t("panels.meanError")),
        goals.length > 1 && known.length > 0 && h("p", { class: "measure-more" },
          t("panels.farthest", { name: vertexWords(goals[far].vertex), mm: mm(most) })),
        h(Read),
      ]);
    };
    return () => {
      const { goals } = state.document;
      if (goals.length === 0) {
        return h("section", { class: "part-section empty", "aria-label": t("panels.goals") }, [
          h("span", { class: "empty-mark", "aria-hidden": "true" }, [icon("target", 32)]),
          h("h2", t("panels.goalsEmpty")),
          h("p", { class: "note" }, t("panels.goalsWhy")),
          h(Adding),
        ]);
      }
      return h("section", { class: "part-section", "aria-label": t("panels.goals") }, [
        head(),
        !state.answer && note("warning", t("panels.noShape")),
        h("p", { class: "goals-title" }, t("panels.target")),
        h("ol", { class: "goals" }, goals.map((one, k) => goal(one, k, errors.value.each[k]))),
        h(Adding),
      ]);
    };
  },
};
