// What is written and can be taken hold of in the view: dimensions, heights, points that become goals,
// targets, lines to surfaces and the handles that move a target. From the page's state to items of the annotations.

import { moveGoal, vertexPoint } from "../document/goals.js";
import { isPoint } from "../document/kinds.js";
import { edit, endMerge, select, state, view } from "../store.js";
import { t } from "../text/text.js";
import { linesOf } from "./compared.js";
import { dimensionItems } from "./dimensions.js";
import { dragged, gizmoItems, LENGTH } from "./gizmo.js";
import { skinBounds } from "./skin.js";
import { centreAt, LAST } from "./topology.js";
import { number, partOf } from "./words.js";

const MOST_HEIGHTS = 40; // numbers that are still read
const MOST_DOTS = 160; // points that are offered: above, beams have none
const NEAR = 0.2; // mm, a line as short as the printer is coarse is not drawn
const TENTH = 10; // targets are set in tenths of a millimetre

const mm = (value) => t("shape.mm", { mm: number(value) });

/** Return the items for what the view shows: its skin, the result (and the engine's own, from which that
 * was placed), and whether goals are worked on. */
export function noteItems(viewer, { result, own }, { goals }) {
  const items = [];
  if (view.dimensions) items.push(...dimensionItems(skinBounds(viewer.body.skin), mm));
  if (view.heights) items.push(...heightItems(result));
  items.push(...collisionItems(result));
  if (goals) items.push(...lineItems(own), ...spotItems(), ...pointItems(result), ...targetItems(result));
  return items;
}

/** A ring where parts have met by the frame; the place of the worst moment goes along with the part. */
function collisionItems(result) {
  return (result.collisions ?? []).filter(({ first }) => first <= view.frame).map((one, k) => {
    const [{ kind, index }] = one.parts.map((part) => partOf(result, part));
    const [then, now] = [one.frame + one.share, view.frame].map((frame) => centreAt(result, kind, index, frame));
    const at = one.place.map((x, axis) => x + now[axis] - then[axis]);
    return { id: `collision-${k}`, kind: "ring", className: "note-collision", at };
  });
}

function heightItems(result) {
  const joints = result.joint_numbers.map((joint, index) => ({
    joint, at: centreAt(result, "joint", index, view.frame),
  }));
  joints.sort((a, b) => Math.abs(b.at[2]) - Math.abs(a.at[2]));
  return joints.slice(0, MOST_HEIGHTS).map(({ joint, at }) => ({
    id: `height-${joint}`, kind: "text", className: "note-height", at, shift: [0, -14], text: number(at[2]),
  }));
}

/** Lines from where parts of the shape are to where they should be, as on a surface, at the end of the motion. */
function lineItems(own) {
  if (view.frame !== LAST) return [];
  const far = linesOf(own).filter(([a, b]) => Math.hypot(...a.map((x, axis) => x - b[axis])) > NEAR);
  return far.slice(0, MOST_DOTS).flatMap(([a, b], k) => [
    { id: `line-${k}`, kind: "line", a, b, className: "note-goal" },
    { id: `line-${k}-end`, kind: "dot", at: b, className: "note-goal" },
  ]);
}

/** Rings at places of a surface that a panel speaks of. */
function spotItems() {
  return (state.spots ?? []).map((at, k) => ({ id: `spot-${k}`, kind: "ring", className: "note-collision", at }));
}

/** The points of the shape that can become goals, while the page waits for one. */
function pointItems(result) {
  if (!state.pickVertex) return [];
  const centres = (kind, numbers, vertex) => numbers.map((k, index) => ({
    id: `${kind}-${k}`, kind: "dot", className: "note-point", at: centreAt(result, kind, index, view.frame),
    name: t(`shape.point-${kind}`, { number: k }),
    onPress: () => state.pickVertex?.(vertex(k)),
    onKey: (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      event.stopPropagation();
      state.pickVertex?.(vertex(k));
    },
    onHover: (on) => { state.hover = on ? { [kind]: k } : null; },
  }));
  const joints = centres("joint", result.joint_numbers, (k) => ["joint", k, "centre"]);
  const beams = centres("beam", result.beam_numbers, (b) => ["beam", b, "middle", "centre"]);
  return joints.length + beams.length > MOST_DOTS ? joints : [...beams, ...joints];
}

function targetItems(result) {
  return state.document.goals.flatMap((goal, k) => {
    if (!isPoint(goal)) return [];
    const { vertex, target } = goal;
    const point = vertexPoint(result, vertex, view.frame);
    const chosen = state.selection.goal === k;
    const className = `note-goal ${chosen ? "chosen" : ""} ${state.hover?.goal === k ? "near" : ""}`;
    const distance = point && Math.hypot(...point.map((x, axis) => x - target[axis]));
    const marker = {
      id: `target-${k}`, kind: "target", at: target, className,
      name: t("shape.target", { number: k + 1, mm: distance === null ? "–" : number(distance) }),
      onPress: () => select({ goal: k }), onKey: (event) => nudge(event, k),
      onHover: (on) => { state.hover = on ? { goal: k } : null; },
    };
    if (!point) return [marker];
    return [
      { id: `line-${k}`, kind: "line", a: point, b: target, className },
      { id: `place-${k}`, kind: "dot", at: point, className },
      {
        id: `apart-${k}`, kind: "text", at: target, shift: [0, chosen ? 20 : -16], className,
        text: mm(distance),
      },
      marker,
    ];
  });
}

/** Move target k by keys: arrows in the plane, PageUp and PageDown along z; 1 mm, with shift 10. */
function nudge(event, k) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const step = {
    ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowDown: [0, -1, 0], ArrowUp: [0, 1, 0],
    PageDown: [0, 0, -1], PageUp: [0, 0, 1],
  }[event.key];
  if (event.key === "Enter" || event.key === " ") select({ goal: k });
  else if (step) {
    const { target } = state.document.goals[k];
    move(k, target.map((x, axis) => x + step[axis] * (event.shiftKey ? 10 : 1)));
  } else return;
  event.preventDefault();
  event.stopPropagation();
}

function move(k, target) {
  const tidy = target.map((x) => Math.round(x * TENTH) / TENTH);
  edit((document) => moveGoal(document, k, tidy), {
    label: t("shape.moveTarget", { number: k + 1 }), merge: `goal-${k}-target`,
  });
}

/** Return project -> handles of the selected target, or null where none is. */
export function handlesOf(viewer) {
  const k = state.selection.goal;
  if (!(k in state.document.goals) || !isPoint(state.document.goals[k])) return null;
  const onPress = (event, handle) => drag(viewer, event, handle, k);
  return (project) => {
    const { target } = state.document.goals[k] ?? {};
    if (!target) return [];
    const size = LENGTH * viewer.pixel(target);
    const name = (axes) => t("shape.moveAlong", { axes });
    return gizmoItems(target, size, project, { onPress, name, active });
  };
}

let active = null; // id of the handle that is dragged

function drag(viewer, event, handle, k) {
  const element = event.currentTarget;
  const start = state.document.goals[k].target;
  const rayAt = viewer.hold();
  const begin = rayAt(event.clientX, event.clientY);
  active = handle.id;
  const follow = (now) => {
    if (now.pointerId !== event.pointerId || !(k in state.document.goals)) return;
    move(k, dragged(start, handle, begin, rayAt(now.clientX, now.clientY)));
  };
  const end = (now) => {
    if (now.pointerId !== event.pointerId) return;
    active = null;
    viewer.release();
    endMerge();
    for (const [name, listener] of listeners) globalThis.removeEventListener(name, listener);
    viewer.stage.invalidate();
  };
  const listeners = [["pointermove", follow], ["pointerup", end], ["pointercancel", end]];
  for (const [name, listener] of listeners) globalThis.addEventListener(name, listener);
  element.releasePointerCapture?.(event.pointerId); // touch captures the handle, which is made anew
}
