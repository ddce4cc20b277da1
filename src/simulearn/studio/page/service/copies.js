// Copies of documents in this browser, with their undo history: what a reload brings back.

import { readDocument } from "../document/document.js";
import { emptyHistory } from "../document/history.js";

const INDEX = "simulearn.designs"; // [{ id, name, time, saved }], the newest first
const MOST_TEXT = 1_500_000; // characters of one copy; browsers keep some five million in all
const keyOf = (id) => `simulearn.design.${id}`;

const texts = new WeakMap(); // document -> JSON; documents never change

function json(document) {
  if (!texts.has(document)) texts.set(document, JSON.stringify(document));
  return texts.get(document);
}

/** Return {revision, saved, document, history} of a copy, or null. */
export function readCopy(id) {
  try {
    const { revision, saved, document, past, future } = JSON.parse(localStorage.getItem(keyOf(id)));
    return { revision, saved, document: readDocument(document), history: readHistory(past, future) };
  } catch {
    return null; // none, no storage, or one of a page that wrote something else
  }
}

function readHistory(past, future) {
  try {
    const steps = (list) => list.map(({ label, document }) => ({ label, document: readDocument(document) }));
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
  const steps = (list) => {
    const kept = [];
    for (const { label, document: before } of list.toReversed()) {
      const text = `{"label":${JSON.stringify(label)},"document":${json(before)}}`;
      room -= text.length;
      if (room < 0) break;
      kept.unshift(text);
    }
    return `[${kept.join(",")}]`;
  };
  const past = steps(history.past);
  const future = steps(history.future);
  const head = `"revision":${revision},"saved":${saved},"document":${json(document)}`;
  return `{${head},"past":${past},"future":${future}}`;
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
