// Numbers where the pointer is: of the part under it, of the line being drawn, of a split.

import { h } from "/libraries/vue.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { ratioText } from "./actions.js";
import { toScreen } from "./camera.js";
import { editor } from "./editor.js";
import { shown } from "./lengths.js";
import { marksOf } from "./messages.js";
import { factsOf } from "./parts.js";
import { angle, distance } from "../document/measure.js";

const OFFSET = [16, 18]; // px from the pointer
const OFFSET_TOUCH = [-60, -84]; // px; above a finger
const WIDE = 310; // px; a readout nearer to the right edge goes to the left
const HIGH = 120; // px
const EDGE = 4; // px between a readout and the view's border

const SNAPS = {
  joint: "snapJoint", beam: "snapBeam", crossing: "snapCrossing", align: "snapAlign",
};

export const Readout = {
  render() {
    const { pointer, line, cut, dragging, panning, menu } = editor;
    if (panning || menu) return null;
    if (line && line.points.length > 1 && (pointer || editor.entry?.length || editor.entry?.angle))
      return box(line.next, drawing(line), pointer);
    if (line) return pointer ? box(pointer.point, [place(line.next)], pointer) : null;
    if (cut) return pointer && box(pointer.point, [lengths(cut)], pointer);
    if (dragging) return pointer && editor.snapped && box(pointer.point, moving(), pointer);
    const part = state.hover;
    if (!pointer || !part || part.goal !== undefined || !exists(part)) return null;
    if (editor.popover && part.beam !== undefined && part.beam === editor.popover.beam) return null;
    return box(pointer.point, partRows(part), pointer, "facts");
  },
};

function exists({ joint, beam }) {
  const { grid } = state.document;
  return joint !== undefined ? joint in grid.joints : beam in grid.beams;
}

function box(point, rows, pointer, name = "") {
  const [x, y] = pointer ? pointer.screen : toScreen(editor.camera, point);
  const [dx, dy] = pointer?.touch ? OFFSET_TOUCH : OFFSET;
  const left = x + dx + WIDE > editor.size.width ? x - dx : x + dx;
  const above = y + dy + HIGH > editor.size.height;
  const top = above ? y - dy : Math.max(EDGE, y + dy);
  const style = { transform: `translate(${left}px, ${top}px)` };
  const classes = ["plan-readout", name, { flipped: left < x && !pointer?.touch, above }];
  return h("div", { class: classes, style, "aria-hidden": "true" }, h("div", rows));
}

/** Length and angle of the next beam as two fields, of which one takes what is typed. */
function drawing({ points }) {
  const [p, q] = points.slice(-2);
  const { entry } = editor;
  const field = (name, value, unit) =>
    h("span", { class: ["measure", { active: entry?.field === name, typed: entry?.[name] }] }, [
      entry?.[name] || value, h("i", { class: "caret" }), h("small", unit),
    ]);
  return [
    h("div", { class: "measures" }, [
      field("length", shown(distance(p, q)), "mm"), field("angle", shown(angle(p, q)), "°"),
    ]),
    snapWord(),
  ];
}

function snapWord() {
  const word = SNAPS[editor.snapped?.kind];
  return word ? h("div", { class: "snapped" }, t(`plan.${word}`)) : null;
}

function place([x, y]) {
  return h("div", { class: "row" }, `${shown(x)}, ${shown(y)}`);
}

function lengths({ beam, lengths: [a, b] }) {
  return h("div", { class: "row" }, `${t("plan.beam", { beam })}: ${shown(a)} + ${shown(b)} mm`);
}

function moving() {
  return [place(editor.snapped.point), snapWord()];
}

function partRows(part) {
  const { grid } = state.document;
  const marks = marksOf(state.check, grid);
  const mark = part.joint !== undefined ? marks.joints.get(part.joint) : marks.beams.get(part.beam);
  const title = part.joint !== undefined ? jointTitle(part.joint) : beamTitle(part.beam);
  const facts = factsOf(part).map(({ name, value }) => h("span", [h("small", `${name} `), value]));
  return [
    h("div", { class: "title" }, title),
    h("div", { class: "row" }, facts),
    ...(mark ? mark.messages.map((text) => h("div", { class: ["fault", mark.kind] }, text)) : []),
  ];
}

function jointTitle(k) {
  const name = t("plan.joint", { joint: k });
  return state.document.grid.fixed === k ? `${name} · ${t("plan.fixed")}` : name;
}

function beamTitle(b) {
  const ratio = state.document.grid.actuators[b];
  return `${t("plan.beam", { beam: b })} · ${ratio === 0 ? t("plan.noActuator") : ratioText(ratio)}`;
}
