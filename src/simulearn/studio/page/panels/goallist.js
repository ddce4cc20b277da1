// The goals of a document: how far each is missed, its target and weight.

import { computed, h, nextTick } from "/libraries/vue.js";
import { moveGoal, removeGoal, setPose, setWeight } from "../document/goals.js";
import { isPoint, kindOf } from "../document/kinds.js";
import { mm } from "../service/format.js";
import { goalFacts } from "../shape/compared.js";
import { edit, endMerge, select, stale, state } from "../store.js";
import { t } from "../text/text.js";
import { Adding } from "./adding.js";
import { iconButton } from "./controls.js";
import { NumberField } from "./fields.js";
import { goalDetails, goalWords } from "./goalwords.js";
import { icon } from "./icons.js";
import { note, problemNote, Reader } from "./notes.js";
import { SurfaceFacts, surfaceFields } from "./surfacegoal.js";
import { vertexWords } from "./vertices.js";

const AXES = ["x", "y", "z"];
const DIGITS = 2; // of a target, mm
const MOST_WEIGHT = 1000; // only the ratios of weights count

/** The fields of a goal that a vertex comes to a point. */
function pointFields({ vertex, target, weight }, k) {
  const name = vertexWords(vertex);
  const change = (apply, label, merge) => {
    edit(apply, { label, merge });
    if (!merge) endMerge();
  };
  return h("div", { class: "goal-fields" }, [
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
  ]);
}

/** What can be said and changed of a goal, by its kind. */
function body(goal, k) {
  if (isPoint(goal)) return [pointFields(goal, k), details(goal)];
  if (kindOf(goal) !== "surface") return [details(goal)];
  const surface = state.document.surfaces.find(({ name }) => name === goal.surface);
  return [surfaceFields(goal, k), h(SurfaceFacts, { key: "facts", surface })];
}

function details(goal) {
  const { weight, ...rest } = goal;
  const text = goalDetails(isPoint(goal) ? { ...rest, weight: 1 } : goal);
  return text && h("p", { class: "note numbers" }, text);
}

function goal(one, k, facts) {
  const name = goalWords(one);
  const point = isPoint(one);
  const selected = state.selection.goal === k;
  const hover = () => { state.hover = { goal: k }; };
  const leave = () => { state.hover = null; };
  const choose = () => {
    hover();
    if (point && !selected) select({ goal: k });
  };
  const label = [h("span", { class: ["goal-mark", { sheet: kindOf(one) === "surface" }], "aria-hidden": "true" }), h("span", name)];
  return h("li", {
    key: point ? one.vertex.join() : `${kindOf(one)} ${k}`,
    class: ["goal", { selected, hovered: state.hover?.goal === k }],
    onPointerenter: hover, onPointerleave: leave, onFocusin: choose, onFocusout: leave,
  }, [
    h("div", { class: "goal-head" }, [
      point ? h("button", {
        type: "button", class: "goal-name", "aria-pressed": String(selected),
        "aria-label": facts === null ? t("panels.selectGoal", { name })
          : t("panels.goalFacts", { name, mm: mm(facts.mean) }),
        onClick: () => select({ goal: k }),
      }, label) : h("h2", { class: "goal-name" }, label),
      h("span", { class: ["goal-error numbers", { old: stale.value }] }, facts === null ? "–" : mm(facts.mean)),
      iconButton("trash", t("panels.removeGoal", { name }), async (event) => {
        const list = event.currentTarget.closest("ol");
        edit((document) => removeGoal(document, k), { label: t("panels.didRemoveGoal", { name }) });
        select({});
        await nextTick(); // the focus goes on to the goal that took its place
        [...list.querySelectorAll("li")].slice(0, k + 1).at(-1)?.querySelector("button")?.focus();
      }, { class: "icon-button small" }),
    ]),
    facts?.vertex && !point && h("p", { class: ["note numbers", { old: stale.value }] },
      t("surface.worst", { name: vertexWords(facts.vertex), mm: mm(facts.worst) })),
    ...body(one, k),
  ]);
}

/** The choice of where the shape is compared, where there are goals for which that makes sense. */
function pose() {
  const { document } = state;
  if (document.goals.every(isPoint) && document.pose === "fixed") return null;
  return h("label", { class: "checkbox", title: t("surface.freeHint") }, [
    h("input", {
      type: "checkbox", checked: document.pose === "free",
      onChange: ({ target: { checked } }) => edit((before) => setPose(before, checked ? "free" : "fixed"), {
        label: t("surface.didPose"),
      }),
    }), h("span", [t("surface.free"), h("small", t("surface.freeHint"))]),
  ]);
}

export const GoalList = {
  setup() {
    // While a design is simulated anew, the errors of the one before stay, dimmed.
    const found = computed(goalFacts);
    const Read = Reader(() => {
      const { mean } = found.value;
      return mean === null ? "" : t("panels.errorRead", { mm: mm(mean) });
    });
    const head = () => {
      const { each, mean, then, fresh } = found.value;
      const { goals } = state.document;
      const known = each.filter((facts) => facts !== null);
      const most = Math.max(...known.map(({ worst }) => worst));
      const far = each.findIndex((facts) => facts?.worst === most);
      return h("div", { class: ["measure", { old: stale.value || !fresh }] }, [
        h("p", { class: "measure-value numbers" }, [
          mean === null ? "–" : mm(mean),
          then !== null && mean !== null && h("span", {
            class: ["measure-then", then < mean ? "better" : "worse"],
          }, [h("span", { "aria-hidden": "true" }, " → "), mm(then)]),
        ]),
        h("p", { class: "measure-name" }, t("panels.meanError")),
        goals.length > 1 && known.length > 0 && h("p", { class: "measure-more" },
          t("panels.farthest", {
            name: each[far].vertex ? vertexWords(each[far].vertex) : goalWords(goals[far]), mm: mm(most),
          })),
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
        found.value.problem && problemNote(t("surface.failed"), found.value.problem),
        pose(),
        goals.some(isPoint) && h("p", { class: "goals-title" }, t("panels.target")),
        h("ol", { class: "goals" }, goals.map((one, k) => goal(one, k, found.value.each[k]))),
        !goals.every((one) => isPoint(one) || kindOf(one) === "surface")
          && h("p", { class: "note" }, t("surface.other")),
        h(Adding),
      ]);
    };
  },
};
