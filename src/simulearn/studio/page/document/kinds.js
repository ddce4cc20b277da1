// What goals can want, and of what: a vertex at a point, vertices on a surface, and what task files know
// besides. A goal has one of the keys of KINDS; its surface is the name of one of the document's.

import { isNumber, isPlace, limited, rounded } from "./geometry.js";
import { followedFace, hasFace, hasVertex, named } from "./vertices.js";

/** Kinds of goals, and by which key each says what it is about. */
export const KINDS = {
  target: ["vertex", "vertices"],
  surface: ["vertex", "vertices"],
  curve: ["vertex", "vertices"],
  plane: ["vertex", "vertices"],
  direction: ["face", "faces"],
  distance: ["vertices"],
  angle: ["faces"],
  away_from: [],
};
export const ITSELF = "itself"; // what beams can be away from besides surfaces
const WHOSE = ["vertex", "vertices", "face", "faces"];
const WORDS = ["joints", "beams"]; // all joints, the middles of all beams
export const GOAL_KEYS = [...WHOSE, ...Object.keys(KINDS), "slide", "clearance", "weight", "tolerance"];

/** Return which of KINDS a goal is of, or null where it wants nothing or several things. */
export function kindOf(goal) {
  const found = Object.keys(KINDS).filter((key) => goal[key] !== undefined && goal[key] !== null);
  return found.length === 1 ? found[0] : null;
}

/** Return whether a goal is that a single vertex comes to a point: these are edited in the scene. */
export function isPoint(goal) {
  return goal.vertex !== undefined && goal.target !== undefined;
}

/** Return the vertices that a goal names, one by one; [] of goals that are about something else. */
export function verticesOf(goal, grid) {
  if (goal.vertices === "joints") return grid.joints.map((_, k) => ["joint", k, "centre"]);
  if (goal.vertices === "beams") return grid.beams.map((_, b) => ["beam", b, "middle", "centre"]);
  return goal.vertices ?? (goal.vertex ? [goal.vertex] : []);
}

/** Return how many goals an entry stands for, as the server counts them. */
export function rowsOf(goal, grid) {
  if (goal.vertices && kindOf(goal) !== "distance") return verticesOf(goal, grid).length;
  return goal.direction && goal.faces ? goal.faces.length : 1;
}

/** Return whether a grid has all that a goal names. */
export function fits(grid, goal) {
  return WHOSE.every((key) => !(key in goal) || namesParts(goal, key, grid));
}

// What the values of a goal have to be, and how that is said.
const RULES = {
  target: [(value) => isPlace(value, 3), "a target is [x, y, z] in mm"],
  curve: [isCurve, "a curve has points, at least two [x, y, z] in mm"],
  plane: [isPlane, "a plane has a point and a normal, both [x, y, z]"],
  direction: [(value) => isPlace(value, 3), "a direction is [x, y, z]"],
  distance: [isPositive, "a distance is more than 0 mm"],
  angle: [(value) => isNumber(value) && value >= 0 && value <= 180, "an angle is from 0 to 180 degrees"],
  slide: [(value) => typeof value === "boolean", "it is true or false"],
  clearance: [isSize, "it is at least 0 mm"],
  weight: [isSize, "it is a number of at least 0"],
  tolerance: [isPositive, "a tolerance is more than 0 mm"],
};

/** Return the goal that an object describes; check(holds, text) throws an error that says what is wrong. */
export function readGoal(data, where, grid, surfaces, check) {
  const said = Object.entries(data).filter(([, value]) => value !== null);
  const goal = { ...Object.fromEntries(said), weight: data.weight ?? 1 };
  for (const key of ["vertex", "face"]) if (key in goal) goal[key] = named(goal[key]);
  for (const key of ["vertices", "faces"]) if (Array.isArray(goal[key])) goal[key] = goal[key].map(named);
  for (const key of WHOSE)
    if (key in goal)
      check(namesParts(goal, key, grid), `${where}.${key} is ${brief(goal[key])}; the grid has no such ${key}`);
  const kind = kindOf(goal);
  const kinds = Object.keys(KINDS).join(", ");
  check(kind !== null, `${where} wants nothing, or several things; a goal has one of ${kinds}`);
  const whose = WHOSE.filter((key) => key in goal);
  const allowed = KINDS[kind];
  check(whose.length === Math.min(1, allowed.length) && whose.every((key) => allowed.includes(key)),
    `${where} has ${whose.join(" and ") || "neither"}; with ${kind} it has ${allowed.join(" or ") || "no parts"}`);
  for (const [key, [holds, text]] of Object.entries(RULES))
    if (key in goal) check(holds(goal[key]), `${where}.${key} is ${brief(goal[key])}; ${text}`);
  const names = surfaces.map(({ name }) => name);
  for (const [key, known] of [["surface", names], ["away_from", [...names, ITSELF]]])
    if (key in goal)
      check(known.includes(goal[key]), `${where}.${key} is ${brief(goal[key])}; the document has no such surface`);
  return goal;
}

function namesParts(goal, key, grid) {
  if (key === "vertices" && WORDS.includes(goal[key])) return true;
  const many = key === "vertices" || key === "faces";
  if (many && !(Array.isArray(goal[key]) && goal[key].length > 0)) return false;
  const has = key.startsWith("vert") ? hasVertex : hasFace;
  return (many ? goal[key] : [goal[key]]).every((one) => has(grid, one));
}

function isCurve(value) {
  const points = value?.points;
  return Array.isArray(points) && points.length >= 2 && points.every((point) => isPlace(point, 3));
}

function isPlane(value) {
  return isPlace(value?.point, 3) && isPlace(value?.normal, 3);
}

function isPositive(value) {
  return isNumber(value) && value > 0;
}

function isSize(value) {
  return isNumber(value) && value >= 0;
}

/** Return goals where their vertices went, without those that have none left or one that is taken.
 *
 * vertexOf(vertex): the vertex after the change, null where it is gone.
 */
export function followedGoals(goals, vertexOf) {
  const seen = new Set();
  const next = goals.map((goal) => followed(goal, vertexOf)).filter((goal) => {
    if (goal === null || !isPoint(goal)) return goal !== null;
    const key = goal.vertex.join();
    if (seen.has(key)) return false;
    return seen.add(key);
  });
  return alike(next, goals) ? goals : next;
}

function followed(goal, vertexOf) {
  const kind = kindOf(goal);
  const next = { ...goal };
  const faceOf = (face) => followedFace(face, vertexOf);
  for (const [one, many, follow] of [["vertex", "vertices", vertexOf], ["face", "faces", faceOf]]) {
    if (goal[one]) next[one] = follow(goal[one]);
    if (Array.isArray(goal[many])) next[many] = distinct(goal[many].map(follow));
    const few = kind === "distance" || kind === "angle" ? 2 : 1;
    if (next[one] === null || (Array.isArray(next[many]) && next[many].length < few)) return null;
    if (goal[one] && alike(next[one], goal[one])) next[one] = goal[one];
    if (Array.isArray(goal[many]) && alike(next[many].map(String), goal[many].map(String))) next[many] = goal[many];
  }
  return Object.keys(next).every((key) => next[key] === goal[key]) ? goal : next;
}

function distinct(parts) {
  const known = new Map();
  for (const part of parts) if (part !== null && !known.has(part.join())) known.set(part.join(), part);
  return [...known.values()];
}

/** Return a goal whose places move by map([x, y, z]), a similarity: turned, mirrored, shifted or scaled. */
export function movedGoal(goal, map) {
  const origin = map([0, 0, 0]);
  const along = (direction) => map(direction).map((x, axis) => rounded(x - origin[axis]));
  const size = Math.hypot(...along([1, 0, 0]));
  const place = (point) => map(point).map(limited);
  const next = { ...goal };
  if (goal.target) next.target = place(goal.target);
  if (goal.curve) next.curve = { points: goal.curve.points.map(place) };
  if (goal.plane) next.plane = { point: place(goal.plane.point), normal: along(goal.plane.normal) };
  if (goal.direction) next.direction = along(goal.direction);
  for (const key of ["distance", "clearance"]) if (goal[key]) next[key] = rounded(size * goal[key]);
  return next;
}

/** Return the document with the places of its goals and surfaces moved by map, a similarity. */
export function movedWishes(document, map) {
  const { goals, surfaces } = document;
  if (goals.length === 0 && surfaces.length === 0) return document;
  const moved = surfaces.map((surface) => ({
    ...surface, vertices: surface.vertices.map((vertex) => map(vertex).map(limited)),
  }));
  return { ...document, goals: goals.map((goal) => movedGoal(goal, map)), surfaces: moved.length ? moved : surfaces };
}

/** Return whether two documents want the same: goals, surfaces and pose, compared by identity. */
export function sameWishes(a, b) {
  return a.goals === b.goals && a.surfaces === b.surfaces && a.pose === b.pose;
}

function alike(a, b) {
  return a.length === b.length && a.every((entry, k) => entry === b[k]);
}

function brief(value) {
  const text = value === undefined ? "missing" : JSON.stringify(value);
  return text.length > 60 ? `${text.slice(0, 57)}...` : text;
}
