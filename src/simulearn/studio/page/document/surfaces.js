// The surfaces of a document: triangles on which a grid is to lie, or from which it keeps away. Each is
// named by goals, and goes with the last of them.

import { isPlace } from "./geometry.js";
import { ITSELF, kindOf } from "./kinds.js";

const MOST = 4; // surfaces, as the server
const MOST_TRIANGLES = 4000; // of one, as the server
const MOST_NAME = 100; // characters

/** Return whether a document can have another surface. */
export function hasRoom(document) {
  return document.surfaces.length < MOST;
}

/** Return the document with a surface { vertices, faces } and the goal that all joints come to it.
 *
 * With pose "free" the shape may be placed anywhere; null: as before.
 */
export function addSurface(document, name, { vertices, faces }, pose = null) {
  if (!hasRoom(document)) return document;
  const taken = new Set([ITSELF, ...document.surfaces.map((surface) => surface.name)]);
  const stem = name.slice(0, MOST_NAME - 4) || "surface";
  let own = stem;
  for (let k = 2; taken.has(own); k += 1) own = `${stem} ${k}`;
  return {
    ...document,
    goals: [...document.goals, { vertices: "joints", surface: own, weight: 1 }],
    surfaces: [...document.surfaces, { name: own, vertices, faces }],
    pose: pose ?? document.pose,
  };
}

/** Return the document with other triangles for a surface, as when its file is read in another unit. */
export function withSurface(document, name, { vertices, faces }) {
  const surfaces = document.surfaces.map((one) => (one.name === name ? { name, vertices, faces } : one));
  return { ...document, surfaces };
}

/** Return the document without surfaces that no goal names; without such goals its pose is fixed. */
export function withoutUnused(document) {
  const used = new Set(document.goals.flatMap(({ surface, away_from: body }) => [surface, body]));
  const surfaces = document.surfaces.filter(({ name }) => used.has(name));
  const placed = document.goals.some((goal) => kindOf(goal) !== "target");
  const pose = placed ? document.pose : "fixed";
  if (surfaces.length === document.surfaces.length && pose === document.pose) return document;
  return { ...document, surfaces, pose };
}

/** Return whether a goal is about all joints or beams, of whatever grid. */
export function isOfAll(goal) {
  return kindOf(goal) === "surface" && typeof goal.vertices === "string";
}

/** Return a design without goals that takes the place of another, with those of that one that any grid can
 * have: who has a surface tries several grids. */
export function keepingSurfaces(before, document) {
  const goals = before.goals.filter(isOfAll);
  if (goals.length === 0 || document.goals.length > 0) return document;
  return withoutUnused({ ...document, goals, surfaces: before.surfaces, pose: before.pose });
}

/** Return {low, high}, the corners of the box around points. */
export function boxOf(points) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const point of points) {
    point.forEach((x, axis) => {
      if (x < low[axis]) low[axis] = x;
      if (x > high[axis]) high[axis] = x;
    });
  }
  return { low, high };
}

/** Return the surfaces that data describes; check(holds, text) throws an error that says what is wrong. */
export function readSurfaces(data, check) {
  check(Array.isArray(data) && data.length <= MOST, `surfaces are not a list of at most ${MOST}`);
  const names = new Set([ITSELF]);
  return data.map((surface, k) => {
    const where = `surfaces[${k}]`;
    const { name, vertices, faces } = surface ?? {};
    const titled = typeof name === "string" && name !== "" && name.length <= MOST_NAME && !names.has(name);
    check(titled, `${where}.name is none, or another's`);
    names.add(name);
    const many = (list, most) => Array.isArray(list) && list.length > 0 && list.length <= most;
    check(many(vertices, 3 * MOST_TRIANGLES) && vertices.every((vertex) => isPlace(vertex, 3)),
      `${where}.vertices are not at most ${3 * MOST_TRIANGLES} places [x, y, z] in mm`);
    const isCorner = (i) => Number.isInteger(i) && i >= 0 && i < vertices.length;
    check(many(faces, MOST_TRIANGLES) && faces.every((face) => (
      Array.isArray(face) && face.length === 3 && face.every(isCorner))),
    `${where}.faces are not at most ${MOST_TRIANGLES} triangles of its vertices`);
    return { name, vertices, faces };
  });
}
