// Goals: where vertices of the morphed grid are wanted, and how far from their targets they are.

import { isTarget } from "./document.js";
import { isNumber, limited, rounded } from "./geometry.js";
import { fits, isPoint } from "./kinds.js";
import { same } from "./numbering.js";
import { withoutUnused } from "./surfaces.js";
import { hasVertex } from "./vertices.js";

const SECTION = { start: 0, middle: 1, end: 2 };
const MOST_WEIGHT = 1e6; // only ratios of weights count
const LAST = 11; // number of the last frame: after creep

/** Add the goal that a vertex comes to a target [x, y, z]; a goal of that vertex is replaced. */
export function addGoal(document, vertex, target, weight = 1) {
  const { grid, goals } = document;
  if (!hasVertex(grid, vertex) || !isTarget(target) || !isWeight(weight)) return document;
  const k = goalOf(document, vertex);
  if (k !== null) return change(document, k, { target, weight });
  const goal = { vertex: [...vertex], target: target.map(limited), weight: rounded(weight) };
  return { ...document, goals: [...goals, goal] };
}

/** Return the number of the goal that a vertex comes to a target, or null. */
export function goalOf(document, vertex) {
  const k = document.goals.findIndex((goal) => isPoint(goal) && same(goal.vertex, vertex));
  return k < 0 ? null : k;
}

/** Put the target of goal k at [x, y, z]. */
export function moveGoal(document, k, target) {
  const possible = isTarget(target) && k in document.goals && isPoint(document.goals[k]);
  return possible ? change(document, k, { target }) : document;
}

/** Set how much goal k counts; at least 0. */
export function setWeight(document, k, weight) {
  return isWeight(weight) ? change(document, k, { weight }) : document;
}

/** Choose the vertices of goal k, on a surface: "joints", "beams" or a list. */
export function setVertices(document, k, vertices) {
  const next = { ...document.goals[k], vertices };
  delete next.vertex;
  return k in document.goals && fits(document.grid, next) ? replaced(document, k, next) : document;
}

/** Let the vertices of goal k slide on their surface or not. */
export function setSlide(document, k, slide) {
  const { slide: before = true, ...goal } = document.goals[k] ?? {};
  if (!(k in document.goals) || before === slide) return document;
  return replaced(document, k, slide ? goal : { ...goal, slide });
}

/** Set how far off (mm) prints may be of goal k; null: it does not matter. */
export function setTolerance(document, k, tolerance) {
  const { tolerance: before = null, ...goal } = document.goals[k] ?? {};
  const possible = tolerance === null || (isNumber(tolerance) && tolerance > 0);
  if (!(k in document.goals) || before === tolerance || !possible) return document;
  return replaced(document, k, tolerance === null ? goal : { ...goal, tolerance: rounded(tolerance) });
}

/** Let the shape be placed wherever the goals fit best ("free"), or see them from the fixed joint. */
export function setPose(document, pose) {
  return pose === document.pose ? document : { ...document, pose };
}

/** Remove goal k, and its surface where no other goal names it. */
export function removeGoal(document, k) {
  if (!(k in document.goals)) return document;
  return withoutUnused({ ...document, goals: document.goals.filter((_, n) => n !== k) });
}

/** Return the place [x, y, z] of a vertex in a frame of a result, or null where the result lacks it.
 *
 * The vertex has the document's numbers. frame: 0 to 11; fractions lie between two frames.
 */
export function vertexPoint(result, vertex, frame = LAST) {
  const at = Math.min(LAST, Math.max(0, frame));
  const before = Math.floor(at);
  const corners = cornersOf(result, vertex);
  if (corners === null) return null;
  const point = mean(corners, before);
  if (before === at) return point;
  const after = mean(corners, before + 1);
  return point.map((x, axis) => x + (at - before) * (after[axis] - x));
}

/** Return how far vertices are from their targets: {each: [mm or null], mean: mm or null}.
 *
 * mean is weighted; vertices that the result lacks do not count, and no goals but points.
 */
export function goalErrors(result, goals, frame = LAST) {
  const each = goals.map((goal) => {
    const { vertex, target } = goal;
    const point = isPoint(goal) ? vertexPoint(result, vertex, frame) : null;
    return point && Math.hypot(...point.map((x, axis) => x - target[axis]));
  });
  let [sum, total] = [0, 0];
  each.forEach((error, k) => {
    if (error === null) return;
    sum += goals[k].weight * error;
    total += goals[k].weight;
  });
  return { each, mean: total > 0 ? sum / total : null };
}

/** Return {numbers, start, count, stride}: where a vertex's corners are in a result's frames. */
function cornersOf(result, [part, number, ...rest]) {
  const joint = part === "joint";
  const list = joint ? result.joint_numbers : result.beam_numbers;
  const index = list ? list.indexOf(number) : number;
  const count = joint ? result.jointCount : result.beamCount;
  if (index < 0 || index >= count) return null;
  const corner = rest.at(-1);
  const size = joint ? 8 : 4; // corners of a joint, of a section
  const first = joint ? index * 8 : (index * 3 + SECTION[rest[0]]) * 4;
  return {
    numbers: joint ? result.joints : result.beams,
    stride: count * (joint ? 24 : 36),
    first: 3 * (corner === "centre" ? first : first + corner),
    count: corner === "centre" ? size : 1,
  };
}

function mean({ numbers, stride, first, count }, frame) {
  const point = [0, 0, 0];
  const start = frame * stride + first;
  for (let k = 0; k < 3 * count; k += 1) point[k % 3] += numbers[start + k] / count;
  return point;
}

function change(document, k, { target, weight }) {
  const goal = document.goals[k];
  if (!goal) return document;
  const next = { ...goal };
  if (target) next.target = target.map(limited);
  if (weight !== undefined) next.weight = rounded(weight);
  if (same(next.target ?? [], goal.target ?? []) && next.weight === goal.weight) return document;
  return replaced(document, k, next);
}

function replaced(document, k, goal) {
  return { ...document, goals: document.goals.map((one, n) => (n === k ? goal : one)) };
}

function isWeight(value) {
  return isNumber(value) && value >= 0 && value <= MOST_WEIGHT;
}
