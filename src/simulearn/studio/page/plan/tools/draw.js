// The tool Draw: click corner after corner of a line of beams. Typed digits set length and angle of
// the next beam. The line is added to the document when it ends, as one step of undo.

import { addPolyline } from "../../document/drawing.js";
import { snap } from "../../document/snapping.js";
import { t } from "../../text/text.js";
import { edit, select, state } from "../../store.js";
import { announce, beamWidth, clearMarks, editor, reach, snapStep, viewMiddle } from "../editor.js";
import { placeOf } from "../focus.js";
import { samePoint } from "../geometry.js";
import { backspace, emptyLine, isTyping, place, target, toggleField, type } from "./polyline.js";

const JOIN = 1; // mm; points that are nearer become one joint
const DRAG = 8; // px between pressing and releasing that make a beam

let line = emptyLine();
let pointed = null; // the last place of the pointer: { point, touch, alt }
let pressed = null; // screen place of a press that put the first corner

export const draw = {
  enter() {
    line = emptyLine();
    pointed = null;
  },

  hover(pointer) {
    pointed = pointer;
    show();
  },

  press(pointer) {
    pointed = pointer;
    show();
    pressed = null;
    if (line.points.length) return;
    pressed = pointer.screen;
    corner();
  },

  drag(pointer) {
    pointed = pointer;
    show();
  },

  release(pointer) {
    pointed = pointer;
    show();
    if (pressed && Math.hypot(pointer.screen[0] - pressed[0], pointer.screen[1] - pressed[1]) < DRAG) return;
    corner();
  },

  leave() {
    pointed = null;
    if (editor.line) show();
    else editor.snapped = null;
  },

  key(event) {
    const { key } = event;
    if (key === "Enter") return enter();
    if (key === "Escape") return escape();
    if (key === "Backspace" && line.points.length) return change(backspace(line));
    const undoes = key.toLowerCase() === "z" && (event.ctrlKey || event.metaKey) && !event.shiftKey;
    if (undoes && line.points.length) return change({ ...emptyLine(), points: line.points.slice(0, -1) });
    if (key === "Tab" && line.points.length && !event.shiftKey) return change(toggleField(line));
    if (key.length !== 1 || event.ctrlKey || event.metaKey || event.altKey) return false;
    const next = type(line, key);
    return next ? change(next) : false;
  },

  /** End the line: what is drawn becomes part of the document. */
  finish,

  cancel() {
    line = emptyLine();
    clearMarks();
  },
};

function change(next) {
  line = next;
  show();
  return true;
}

/** Place the next corner where the marks show it. */
function corner() {
  const point = nextPoint();
  const placed = place(line, point);
  line = placed.line;
  if (placed.ended) finish();
  else show();
}

function enter() {
  if (isTyping(line)) corner();
  else if (line.points.length > 1) finish();
  else if (line.points.length === 0) {
    // By keyboard alone a line begins at the part in focus, or in the middle of the view.
    const focused = placeOf(state.document.grid, editor.focus);
    const start = pointed ? nextPoint() : focused ?? viewMiddle().map(Math.round);
    change({ ...line, points: [start] });
  }
  return true;
}

function escape() {
  if (isTyping(line)) return change({ ...emptyLine(), points: line.points });
  if (line.points.length > 1) return change({ ...line, points: line.points.slice(0, -1) });
  if (line.points.length === 1) {
    draw.cancel();
    return true;
  }
  state.tool = "select";
  return true;
}

function finish() {
  const { points } = line;
  draw.cancel();
  if (points.length < 2) return;
  const before = state.document.grid;
  edit((document) => addPolyline(document, points, { tolerance: JOIN }), { label: t("plan.editDraw") });
  const { grid } = state.document;
  select({});
  editor.focus = { joint: grid.joints.length - 1 };
  announce(t("plan.saidDrawn", {
    beams: grid.beams.length - before.beams.length, joints: grid.joints.length - before.joints.length,
  }));
}

/** Return where the next corner goes: snapped, or as typed. */
function nextPoint() {
  const from = line.points.at(-1) ?? null;
  if (!pointed) return target(line, from ?? viewMiddle());
  return target(line, editor.snapped?.point ?? pointed.point);
}

function show() {
  const from = line.points.at(-1) ?? null;
  if (!pointed) editor.snapped = null;
  else if (pointed.alt) editor.snapped = { point: pointed.point, kind: "none", guides: [] };
  else editor.snapped = snapOf(pointed, from);
  const next = pointed || isTyping(line) ? nextPoint() : null;
  const points = next && !(from && samePoint(from, next)) ? [...line.points, next] : line.points;
  editor.line = { points, fixed: line.points.length, joints: newJoints(points), next: next ?? from };
  editor.entry = from ? { length: line.length, angle: line.angle, field: line.field } : null;
}

/** Snap to the document and to the line's own corners. */
function snapOf({ point, touch }, from) {
  const radius = reach(touch);
  const own = line.points.slice(0, -1).find(([x, y]) => Math.hypot(x - point[0], y - point[1]) <= radius);
  if (own) return { point: own, kind: "joint", guides: [] };
  const last = line.points.at(-1);
  if (last && Math.hypot(last[0] - point[0], last[1] - point[1]) <= radius / 2)
    return { point: last, kind: "joint", guides: [] };
  return snap(point, {
    document: state.document, from, grid: snapStep(), radius: Math.min(radius, beamWidth()),
  });
}

/** Return the joints that the line would add, crossings and touches too. */
function newJoints(points) {
  if (points.length < 2) return points;
  const { document } = state;
  const next = addPolyline(document, points, { tolerance: JOIN });
  return next.grid.joints.slice(document.grid.joints.length);
}
