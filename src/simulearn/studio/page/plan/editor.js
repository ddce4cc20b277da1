// What the plan shows beside the document: camera, pointer, and the marks of the tool in use. It is
// not part of the document and is forgotten with the page.

import { nextTick, shallowReactive } from "/libraries/vue.js";
import { firstCamera, fit, toPlan } from "./camera.js";
import { bounds } from "../document/measure.js";
import { state } from "../store.js";

const WIDTH = 7.2; // mm, of a beam until the material is known
const REACH = { mouse: 8, touch: 20 }; // px around a joint that still hit it
// px around what is fitted; the tools lie on the left, in a low view (as in the style sheet) on top
const MARGIN = { left: 84, right: 48, top: 56, bottom: 60 };
const LOW_MARGIN = { left: 32, right: 32, top: 72, bottom: 28 };
const NO_MARGIN = { left: 0, right: 0, top: 0, bottom: 0 };
const LOW = 420; // px
const AROUND = 40; // mm on each side of a place

export const editor = shallowReactive({
  camera: firstCamera({ width: 600, height: 600 }),
  fitted: true, // whether the camera is the one that `fitAll` chose; then it follows the window's size
  size: { width: 600, height: 600 },
  pointer: null, // { screen, point, touch } while the pointer is over the plan
  dragging: false, // whether parts are being moved
  pressed: false, // whether a button or finger is down
  keys: false, // whether the last input was a key: then the focus is shown
  grab: false, // whether the space bar is down, to move the plan
  panning: false, // whether the plan is being moved
  focus: null, // { joint } or { beam }: what keys reach by Tab
  snapped: null, // what `snap` found: { point, kind, guides, text }
  line: null, // { points, joints }: the line being drawn and the joints it will add
  entry: null, // { length, angle, field }: what is typed while drawing
  box: null, // [p, q] in mm: the box being drawn to select
  cut: null, // { beam, t, point }: where the tool Split would split
  menu: null, // { screen, part }: the open context menu
  popover: null, // { beam }: beside which beam the actuator's controls are
  message: "", // the last edit, for screen readers
});

let element = null; // the <svg>

/** Remember the plan's <svg> element. */
export function setElement(svg) {
  element = svg;
}

/** Return where a pixel of the view lies on the page. */
export function onPage([x, y]) {
  const { left, top } = element.getBoundingClientRect();
  return [left + x, top + y];
}

/** Return whether the view is so low that the tools lie in a row. */
export function isLow() {
  return editor.size.height <= LOW;
}

/** Return the width of beams in mm. */
export function beamWidth() {
  return state.material?.section.width ?? WIDTH;
}

/** Return the distance in mm within which the pointer means a joint. */
export function reach(touch) {
  return (touch ? REACH.touch : REACH.mouse) / editor.camera.scale;
}

/** Return the step in mm to which free points snap: finer when zoomed in. */
export function snapStep() {
  return editor.camera.scale > 8 ? 1 : 5;
}

/** Move the camera; it is then no longer the fitted one. */
export function setCamera(camera) {
  editor.camera = camera;
  editor.fitted = false;
}

/** Show all joints. */
export function fitAll() {
  const box = bounds(state.document.grid);
  const half = beamWidth() / 2;
  editor.camera = box
    ? fit(
      { x: [box.min[0] - half, box.max[0] + half], y: [box.min[1] - half, box.max[1] + half] },
      editor.size, isLow() ? LOW_MARGIN : MARGIN,
    )
    : firstCamera(editor.size);
  editor.fitted = true;
}

/** Show a place and what is around it. */
export function showAround([x, y]) {
  setCamera(fit({ x: [x - AROUND, x + AROUND], y: [y - AROUND, y + AROUND] }, editor.size, NO_MARGIN));
}

/** Return the point in mm that lies in the middle of the view. */
export function viewMiddle() {
  return toPlan(editor.camera, [editor.size.width / 2, editor.size.height / 2]);
}

/** Say what an edit did, to those who do not see it. */
export function announce(text) {
  // A blank in turn, so that the same words are read again.
  editor.message = editor.message === text ? `${text}\u00a0` : text;
}

/** Forget the marks of a tool. */
export function clearMarks() {
  Object.assign(editor, { snapped: null, line: null, entry: null, box: null, cut: null, dragging: false });
}

/** Put the keyboard's focus on a part, or on the plan where it is null. */
export async function focusPart(part) {
  editor.focus = part;
  await nextTick();
  const selector = part?.joint !== undefined ? `[data-joint="${part.joint}"]` : `[data-beam="${part?.beam}"]`;
  const target = element?.querySelector(`[role=option]${selector}`) ?? element;
  target?.focus({ preventScroll: true });
}
