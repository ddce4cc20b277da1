// The document that the page edits: a grid, goals, surfaces, what is to be printed on, own materials.

import { FARTHEST, isNumber, isPlace } from "./geometry.js";
import { GOAL_KEYS, fits, readGoal } from "./kinds.js";
import { same } from "./numbering.js";
import { readSurfaces } from "./surfaces.js";
import { isIndex } from "./vertices.js";

export const SCHEMA = "simulearn.document/1";
export const GRID_SCHEMA = "simulearn.grid/1";
const MOST_JOINTS = 20_000; // as the server
const MOST_BEAMS = 2 * MOST_JOINTS;
const MOST_GOALS = 1000;
const MOST_NAME = 200; // characters
export const MOST_PROFILE = 65_536; // characters of a profile or a material, as the server
export const MOST_MATERIALS = 16; // as the server
export const USUAL_MATERIAL = "pla-hot-water";

/** Return a document without joints. */
export function emptyDocument() {
  return {
    schema: SCHEMA,
    name: "",
    grid: {
      schema: GRID_SCHEMA,
      joints: [], beams: [], actuators: [], fixed: 0, material: USUAL_MATERIAL,
    },
    goals: [], // [{ vertex: ["joint", k, "centre"], target: [x, y, z], weight: 1 }]; see kinds.js
    surfaces: [], // [{ name, vertices: [[x, y, z]], faces: [[i, j, k]] }] that goals name
    pose: "fixed", // whether goals are seen from the fixed joint, or "free": the shape goes where they fit best
    printer: "ender-3", // a name, or { profile: the text of one }
    materials: [], // the texts of those that the grid may name besides the server's
  };
}

/** Return the number of joints of a document. */
export function jointCount(document) {
  return document.grid.joints.length;
}

/** Return the number of beams of a document. */
export function beamCount(document) {
  return document.grid.beams.length;
}

/** Return whether two grids are equal number by number. */
export function sameGrid(a, b) {
  if (a === b) return true;
  return (
    a.fixed === b.fixed && a.material === b.material && same(a.actuators, b.actuators)
    && samePairs(a.joints, b.joints) && samePairs(a.beams, b.beams)
  );
}

function samePairs(a, b) {
  return a.length === b.length && a.every(([x, y], k) => x === b[k][0] && y === b[k][1]);
}

/** Return whether two printers have one name or one profile. */
export function samePrinter(a, b) {
  return a === b || (a.profile !== undefined && a.profile === b.profile);
}

/** Return whether two documents have the same texts of materials. */
export function sameMaterials(a, b) {
  return same(a.materials, b.materials);
}

/** Return the document with another grid; goals about what it does not have are dropped. */
export function withGrid(document, grid) {
  if (grid === document.grid) return document;
  const goals = document.goals.filter((goal) => fits(grid, goal));
  return { ...document, grid, goals: goals.length === document.goals.length ? document.goals : goals };
}

/** Return the document that data from a file, a link or the server describes.
 *
 * Throws an Error that says in a sentence what is wrong and where.
 */
export function readDocument(data) {
  const keys = Object.keys(emptyDocument());
  const given = object(data, "the document", keys);
  check(given.schema === SCHEMA, `schema is ${shown(given.schema)}; this page reads "${SCHEMA}"`);
  const { name = "", goals = [], printer = emptyDocument().printer, materials = [], pose = "fixed" } = given;
  const titled = typeof name === "string" && name.length <= MOST_NAME;
  check(titled, `name is ${shown(name)}; it is a text of at most ${MOST_NAME} characters`);
  const grid = readGrid(given.grid);
  check(Array.isArray(goals) && goals.length <= MOST_GOALS, `goals are not a list of at most ${MOST_GOALS}`);
  const surfaces = readSurfaces(given.surfaces ?? [], check);
  const aims = goals.map((goal, k) => (
    readGoal(object(goal, `goals[${k}]`, GOAL_KEYS), `goals[${k}]`, grid, surfaces, check)));
  check(["fixed", "free"].includes(pose), `pose is ${shown(pose)}; it is "fixed" or "free"`);
  return {
    schema: SCHEMA, name, grid, goals: aims, surfaces, pose,
    printer: readPrinter(printer), materials: readMaterials(materials),
  };
}

/** Return texts of materials; what is in them is for the server to say. */
function readMaterials(data) {
  const few = Array.isArray(data) && data.length <= MOST_MATERIALS;
  check(few, `materials are not a list of at most ${MOST_MATERIALS} texts`);
  data.forEach((text, k) => {
    const short = typeof text === "string" && text.length <= MOST_PROFILE;
    check(short, `materials[${k}] is ${shown(text)}; it is a text of at most ${MOST_PROFILE} characters`);
  });
  return [...data];
}

function readPrinter(data) {
  if (isName(data)) return data;
  check(typeof data !== "string", `printer is ${shown(data)}; it is a printer's name`);
  const { profile } = object(data, "printer", ["profile"]);
  const short = typeof profile === "string" && profile.length <= MOST_PROFILE;
  check(short, `printer.profile is ${shown(profile)}; it is a text of at most ${MOST_PROFILE} characters`);
  return { profile };
}

/** Return the grid that data describes, or throw an Error that says what is wrong. */
export function readGrid(data) {
  const keys = Object.keys(emptyDocument().grid);
  const { schema, joints, beams, actuators, fixed, material } = object(data, "the grid", keys);
  check(schema === GRID_SCHEMA, `grid.schema is ${shown(schema)}; this page reads "${GRID_SCHEMA}"`);
  const places = list(joints, "joints", MOST_JOINTS).map((place, k) => {
    check(pair(place, isNumber), `joints[${k}] is ${shown(place)}; a joint is [x, y] in mm`);
    check(place.every((x) => Math.abs(x) <= FARTHEST), `joints[${k}] lies beyond ${FARTHEST} mm`);
    return [...place];
  });
  const seen = new Set();
  const pairs = list(beams, "beams", MOST_BEAMS).map((ends, b) => {
    const text = `beams[${b}] is ${shown(ends)};`;
    const inside = pair(ends, (k) => isIndex(k, places.length));
    check(inside, `${text} a beam is [i, j], two of the joints 0 to ${places.length - 1}`);
    const [i, j] = ends;
    check(i !== j, `${text} a beam joins two different joints`);
    const key = `${Math.min(i, j)} ${Math.max(i, j)}`;
    check(!seen.has(key), `${text} another beam joins the same two joints`);
    seen.add(key);
    return [i, j];
  });
  const ratios = list(actuators, "actuators", MOST_BEAMS);
  check(ratios.length === pairs.length, `actuators has ${ratios.length} ratios for ${pairs.length} beams`);
  ratios.forEach((ratio, b) => {
    const inside = isNumber(ratio) && Math.abs(ratio) <= 1;
    check(inside, `actuators[${b}] is ${shown(ratio)}; a ratio lies in [-1, 1]`);
  });
  const known = isIndex(fixed, places.length) || (places.length === 0 && fixed === 0);
  check(known, `fixed is ${shown(fixed)}; it is the number of a joint`);
  const made = material === undefined || isName(material);
  check(made, `material is ${shown(material)}; it is the name of a material`);
  return {
    schema, joints: places, beams: pairs, actuators: [...ratios], fixed, material: material ?? USUAL_MATERIAL,
  };
}

/** Return whether a value is a place [x, y, z] that a goal may have. */
export function isTarget(value) {
  return isPlace(value, 3);
}

function object(value, what, keys) {
  const fits = typeof value === "object" && value !== null && !Array.isArray(value);
  check(fits, `${what} is ${shown(value)}; it is an object with ${keys.join(", ")}`);
  for (const key of Object.keys(value))
    check(keys.includes(key), `${what} has the key ${shown(key)}; its keys are ${keys.join(", ")}`);
  return value;
}

function list(value, what, most) {
  check(Array.isArray(value), `${what} is ${shown(value)}; it is a list`);
  check(value.length <= most, `${what} has ${value.length} entries; at most ${most} can be computed`);
  return value;
}

function isName(value) {
  return typeof value === "string" && value !== "" && value.length <= MOST_NAME;
}

function pair(value, fits) {
  return Array.isArray(value) && value.length === 2 && value.every(fits);
}

function check(holds, message) {
  if (!holds) throw new Error(message);
}

function shown(value) {
  if (value === undefined) return "missing";
  let text;
  try {
    text = JSON.stringify(value) ?? String(value);
  } catch {
    text = "nested too deeply"; // lists in lists, beyond what can be written
  }
  return text.length > 60 ? `${text.slice(0, 57)}...` : text;
}
