// What can be done with the selection: one list for the toolbar, the keys and the context menu.

import { splitBeam } from "../document/drawing.js";
import {
  copyParts, flipActuators, jointsOf, mirror, moveJoints, pasteParts, removeParts, rotate, setActuators,
  stepActuators,
} from "../document/edit.js";
import { bounds } from "../document/measure.js";
import { edit, endMerge, redo, select, state, undo } from "../store.js";
import { t } from "../text/text.js";
import { announce, editor, fitAll, focusPart, setCamera } from "./editor.js";
import { zoomAt } from "./camera.js";
import { commonRatio, shown } from "./lengths.js";
import { neighbour, tabStop } from "./focus.js";
import { fixJoint } from "./tools/fix.js";
import { currentTool } from "./tools/tools.js";

const PAUSE = 800; // ms; keys pressed within are one step of undo
const APART = 15; // mm between a copy and what it was copied from
const ZOOM = 1.4; // of one press on + or - of the zoom

let clip = null; // what was copied
let pause = 0;

/** Change to a tool; a line that is being drawn ends. */
export function useTool(name) {
  state.tool = name;
  editor.popover = null;
}

/** Return whether anything is selected. */
export function hasSelection() {
  return state.selection.joints.length + state.selection.beams.length > 0;
}

/** Remove the selected parts. */
export function removeSelection() {
  const { joints, beams } = state.selection;
  if (!hasSelection()) return;
  editor.popover = null;
  edit((document) => removeParts(document, { joints, beams }), { label: t("plan.editDelete") });
  select({});
  focusPart(tabStop(state.document.grid, editor.focus));
  announce(t("plan.saidDeleted", { count: joints.length + beams.length }));
}

/** Mirror the selection, or all: "x" exchanges left and right, "y" up and down. */
export function mirrorSelection(axis) {
  edit((document) => mirror(document, state.selection, axis), { label: t("plan.editMirror") });
  announce(t("plan.saidMirrored"));
}

/** Turn the selection, or all, by degrees counter-clockwise. */
export function rotateSelection(degrees) {
  edit((document) => rotate(document, state.selection, degrees), { label: t("plan.editRotate") });
  announce(t("plan.saidRotated", { degrees }));
}

/** Copy the selection to be pasted. */
export function copySelection() {
  if (!hasSelection()) return;
  clip = copyParts(state.document, state.selection);
  announce(t("plan.saidCopied", { joints: clip.joints.length, beams: clip.beams.length }));
}

/** Return whether there is something to paste. */
export function canPaste() {
  return clip !== null;
}

/** Paste at the pointer, or beside what was copied. */
export function paste() {
  if (clip) insert(clip, editor.pointer?.point.map(Math.round) ?? beside(clip));
}

/** Copy the selection and put the copy beside it. */
export function duplicateSelection() {
  if (!hasSelection()) return;
  const copy = copyParts(state.document, state.selection);
  insert(copy, beside(copy));
}

function beside({ joints }) {
  const [x, y] = bounds({ joints }).middle;
  return [x + APART, y - APART];
}

function insert(parts, at) {
  const { joints, beams } = state.document.grid;
  const [firstJoint, firstBeam] = [joints.length, beams.length];
  edit((document) => pasteParts(document, parts, at), { label: t("plan.editPaste") });
  const { grid } = state.document;
  const from = (list, first) => list.map((_, n) => n).slice(first);
  select({ joints: from(grid.joints, firstJoint), beams: from(grid.beams, firstBeam) });
  announce(t("plan.saidPasted", { joints: parts.joints.length, beams: parts.beams.length }));
}

/** Select all joints and beams. */
export function selectAll() {
  const { joints, beams } = state.document.grid;
  select({ joints: joints.map((_, k) => k), beams: beams.map((_, b) => b) });
  announce(t("plan.saidSelected", { joints: joints.length, beams: beams.length }));
}

/** Change actuators by quarters up or down. */
export function stepBeams(steps, beams = state.selection.beams) {
  actuate((document) => {
    let next = document;
    for (let n = Math.abs(steps); n > 0; n--) next = stepActuators(next, beams, Math.sign(steps));
    return next;
  }, beams);
}

/** Set the length of actuators in [0, 1]; the half of the beam that is active stays. */
export function setBeams(length, beams = state.selection.beams) {
  actuate((document) => {
    const down = beams.filter((b) => document.grid.actuators[b] < 0);
    const up = beams.filter((b) => !(document.grid.actuators[b] < 0));
    return setActuators(setActuators(document, down, -length), up, length);
  }, beams);
}

/** Exchange top and bottom; a beam without an actuator gets none. */
export function flipBeams(beams = state.selection.beams) {
  actuate((document) => flipActuators(document, beams), beams);
}

function actuate(change, beams) {
  if (beams.length === 0) return;
  edit(change, { label: t("plan.editActuator"), merge: `plan-actuator-${beams}` });
  endAfterPause();
  announce(t("plan.saidActuator", {
    beams: beams.length === 1 ? t("plan.beam", { beam: beams[0] }) : t("plan.beams", { count: beams.length }),
    ratio: ratioText(commonRatio(state.document.grid, beams)),
  }));
}

/** Return a ratio in words: "50 % top", "none", "mixed" for null. */
export function ratioText(ratio) {
  if (ratio === null) return t("plan.mixed");
  if (ratio === 0) return t("plan.none");
  return t(ratio > 0 ? "plan.top" : "plan.bottom", { percent: shown(Math.abs(ratio) * 100, 0) });
}

/** Move the selected joints, and the ends of the selected beams, by [dx, dy] mm. */
export function nudge(by) {
  if (!hasSelection()) return;
  const numbers = jointsOf(state.document.grid, state.selection);
  const merge = `plan-nudge-${numbers}`;
  edit((document) => moveJoints(document, numbers, by), { label: t("plan.editMoveJoints"), merge });
  endAfterPause();
  const [x, y] = state.document.grid.joints[numbers[0]];
  announce(t("plan.saidNudged", { joint: numbers[0], x: shown(x), y: shown(y) }));
}

function endAfterPause() {
  clearTimeout(pause);
  pause = setTimeout(endMerge, PAUSE);
}

/** Split a beam in the middle. */
export function splitMiddle(beam) {
  edit((document) => splitBeam(document, beam), { label: t("plan.editSplit") });
  select({ joints: [state.document.grid.joints.length - 1] });
  announce(t("plan.saidSplit", { beam }));
}

/** Move the keyboard's focus to the next part in the direction of an arrow key. */
export function moveFocus(key) {
  const { grid } = state.document;
  const part = neighbour(grid, tabStop(grid, editor.focus), key);
  if (part) focusPart(part);
}

/** Zoom about the middle of the view. */
export function zoom(direction) {
  const { width, height } = editor.size;
  setCamera(zoomAt(editor.camera, [width / 2, height / 2], ZOOM ** direction));
}

export function undoLast() {
  const label = state.history.past.at(-1)?.label;
  currentTool().cancel();
  undo();
  announce(label ? t("plan.saidUndone", { label }) : t("plan.saidNothing"));
}

export function redoLast() {
  const label = state.history.future.at(-1)?.label;
  currentTool().cancel();
  redo();
  announce(label ? t("plan.saidRedone", { label }) : t("plan.saidNothing"));
}

export { fitAll, fixJoint };
