// Copies of documents in this browser, with their undo history: what a reload brings back.

import { readDocument } from "../document/document.js";
import { emptyHistory } from "../document/history.js";

const INDEX = "simulearn.designs"; // [{ id, name, time, saved }], the newest first
const MOST_TEXT = 1_500_000; // characters of one copy; browsers keep some five million in all
const keyOf = (id) => `simulearn.design.${id}`;

const texts = new WeakMap(); // document, or vertices of a surface -> JSON; they never change

function json(key, value = key) {
  if (!texts.has(key)) texts.set(key, JSON.stringify(value));
  return texts.get(key);
}

/** Return a table of triangles, which many steps of undo share, and text(document) with numbers in it. */
function sharing() {
  const numbers = new Map(); // vertices -> number
  const meshes = [];
  const numberOf = ({ vertices, faces }) => {
    if (!numbers.has(vertices)) {
      numbers.set(vertices, meshes.length);
      meshes.push(json(vertices, { vertices, faces }));
    }
    return numbers.get(vertices);
  };
  const text = (document) => {
    if (document.surfaces.length === 0) return json(document);
    const surfaces = document.surfaces.map((surface) => ({ name: surface.name, mesh: numberOf(surface) }));
    return JSON.stringify({ ...document, surfaces });
  };
  return { meshes, text };
}

/** Return a document of a copy, with the triangles of its surfaces from the table. */
function whole(document, meshes) {
  const surfaces = (document.surfaces ?? []).map(({ name, mesh }) => ({ name, ...meshes[mesh] }));
  return readDocument({ ...document, surfaces }); // whose surfaces are these arrays, shared again
}

/** Return {revision, saved, document, history} of a copy, or null. */
export function readCopy(id) {
  try {
    const { meshes = [], revision, saved, document, past, future } = JSON.parse(localStorage.getItem(keyOf(id)));
    const history = readHistory(past, future, meshes);
    return { revision, saved, document: whole(document, meshes), history };
  } catch {
    return null; // none, no storage, or one of a page that wrote something else
  }
}

function readHistory(past, future, meshes) {
  try {
    const steps = (list) => list.map(({ label, document }) => ({ label, document: whole(document, meshes) }));
    return { ...emptyHistory(), past: steps(past), future: steps(future) };
  } catch {
    return emptyHistory();
  }
}

/** Keep a copy; return whether the browser took it.
 *
 * Where there is no room, copies go that the server has, the oldest first, then steps of undo.
 */
export function writeCopy(id, { revision, saved, document, history }) {
  const rest = index().filter((entry) => entry.id !== id);
  const entries = [{ id, name: document.name, time: Date.now(), saved }, ...rest];
  for (let most = MOST_TEXT; ; ) {
    try {
      localStorage.setItem(keyOf(id), copyText({ revision, saved, document, history }, most));
      localStorage.setItem(INDEX, JSON.stringify(entries));
      return true;
    } catch {
      const last = entries.findLastIndex((entry) => entry.saved && entry.id !== id);
      if (last >= 0) remove(entries.splice(last, 1)[0].id);
      else if (most > 0) most = most < 1000 ? 0 : most / 4;
      else return false;
    }
  }
}

function copyText({ revision, saved, document, history }, most) {
  let room = most;
  const { meshes, text: textOf } = sharing();
  const now = textOf(document);
  const steps = (list) => {
    const kept = [];
    for (const { label, document: before } of list.toReversed()) {
      const known = meshes.length;
      const text = `{"label":${JSON.stringify(label)},"document":${textOf(before)}}`;
      room -= text.length + meshes.slice(known).join().length;
      if (room < 0) break;
      kept.unshift(text);
    }
    return `[${kept.join(",")}]`;
  };
  const past = steps(history.past);
  const future = steps(history.future);
  const head = `"revision":${revision},"saved":${saved},"document":${now}`;
  return `{${head},"meshes":[${meshes}],"past":${past},"future":${future}}`;
}

function remove(id) {
  try {
    localStorage.removeItem(keyOf(id));
  } catch {
    // Without storage there is nothing to remove.
  }
}

/** Return the documents that this browser has copies of, the newest first. */
export function index() {
  try {
    const entries = JSON.parse(localStorage.getItem(INDEX));
    return Array.isArray(entries) ? entries : [];
  } catch {
    return [];
  }
}
