// The properties of what is selected: a joint, a beam, several, or else the grid.

import { h } from "/libraries/vue.js";
import { placeJoint, removeParts, setBeamLength, setFixed } from "../document/edit.js";
import { splitBeam } from "../document/drawing.js";
import { vertexPoint } from "../document/goals.js";
import { beamLength, beamsAt, bounds } from "../document/measure.js";
import { edit, endMerge, select, stale, state } from "../store.js";
import { t } from "../text/text.js";
import { Actuator } from "./actuator.js";
import { button } from "./controls.js";
import { NumberField, facts } from "./fields.js";
import { MaterialChoice } from "./material.js";
import { mm } from "./parts.js";
import { Transform } from "./transform.js";

/** Return the answer's result if it is of the current grid. */
function current() {
  return stale.value ? null : state.answer?.result;
}

/** Edit, as one step or as one of a run of steps. */
function change(apply, label, merge = null) {
  edit(apply, { label, merge });
  if (merge === null) endMerge();
}

function remove(parts) {
  edit((document) => removeParts(document, parts), { label: t("common.didDelete") });
  select({});
}

function panel(title, note, children) {
  return h("section", { class: "inspector", "aria-label": t("common.properties") }, [
    h("div", { class: "inspector-head" }, [h("h2", title), note && h("span", { class: "badge" }, note)]),
    ...children,
  ]);
}

const deleteButton = (parts) => button(t("common.delete"), () => remove(parts), { glyph: "trash", kind: "danger" });

function joint(k) {
  const { grid } = state.document;
  const result = current();
  const place = (axis) => (value, merge) => change((document) => {
    const point = [...document.grid.joints[k]];
    point[axis] = value;
    return placeJoint(document, k, point);
  }, t("common.didMove", { k }), merge);
  const field = (axis, name) => h(NumberField, {
    key: `${k}${name}`, label: name, name: `${name} ${t("common.ofJoint", { k })}`, unit: "mm",
    value: grid.joints[k][axis], commit: place(axis), merge: `place ${k} ${axis}`,
  });
  const fix = () => change((document) => setFixed(document, k), t("common.didFix", { k }));
  const end = result && vertexPoint(result, ["joint", k, "centre"]);
  const beams = beamsAt(grid, k);
  return panel(t("common.joint", { k }), k === grid.fixed && t("common.fixed"), [
    h("div", { class: "row" }, [field(0, "x"), field(1, "y")]),
    facts([
      end && [t("common.endHeight"), `${mm(end[2])} mm`],
      [t("common.beams"), beams.length ? beams.join(", ") : t("common.none")],
    ]),
    h("div", { class: "row" }, [
      button(t("common.makeFixed"), fix, { glyph: "pin", disabled: k === grid.fixed }),
      deleteButton({ joints: [k], beams: [] }),
    ]),
  ]);
}

function beam(b) {
  const { grid } = state.document;
  const [i, j] = grid.beams[b];
  const net = state.check?.document.grid === grid ? state.check.netLengths?.[b] : null;
  const split = () => change((document) => splitBeam(document, b), t("common.didSplit", { b }));
  return panel(t("common.beam", { b }), t("common.between", { i, j }), [
    h(NumberField, {
      key: b, label: t("common.length"), name: `${t("common.length")} ${t("common.ofBeam", { b })}`,
      unit: "mm",
      value: beamLength(grid, b), least: 1, most: 1e4, merge: `length ${b}`,
      commit: (value, merge) => change((document) => setBeamLength(document, b, value),
        t("common.didLength", { b }), merge),
    }),
    h(Actuator, { beams: [b] }),
    net != null && facts([[t("common.netLength"), `${mm(net)} mm`]]),
    h("div", { class: "row" }, [
      button(t("common.split"), split, { glyph: "split" }),
      deleteButton({ joints: [], beams: [b] }),
    ]),
  ]);
}

function several({ joints, beams }) {
  const counts = [
    joints.length && t(joints.length === 1 ? "common.jointOne" : "common.jointMany", { n: joints.length }),
    beams.length && t(beams.length === 1 ? "common.beamOne" : "common.beamMany", { n: beams.length }),
  ].filter(Boolean);
  return panel(counts.join(", "), t("common.selected"), [
    beams.length > 0 && h(Actuator, { beams }),
    h(Transform, { selection: { joints, beams } }),
    h("div", { class: "row" }, [
      deleteButton({ joints, beams }),
    ]),
  ]);
}

function heights({ lowest_mm: from, highest_mm: to }) {
  return t("common.fromTo", { from: mm(from), to: mm(to) });
}

function grid() {
  const { joints, beams } = state.document.grid;
  const box = bounds(state.document.grid);
  const result = current();
  return panel(t("common.grid"), null, [
    facts([
      [t("common.joints"), joints.length],
      [t("common.beams"), beams.length],
      box && [t("common.size"), `${mm(box.width)} × ${mm(box.height)} mm`],
      result && [t("common.dimension"), `${mm(result.dimension_mm)} mm`],
      result && [t("common.heights"), heights(result)],
    ]),
    h(MaterialChoice),
    joints.length > 0 && h(Transform, { selection: null }),
  ]);
}

export const Inspector = {
  render() {
    const { joints, beams } = state.selection;
    if (joints.length === 1 && beams.length === 0) return joint(joints[0]);
    if (beams.length === 1 && joints.length === 0) return beam(beams[0]);
    return joints.length + beams.length ? several(state.selection) : grid();
  },
};
