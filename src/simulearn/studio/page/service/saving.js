// Saves the document by the id in the page's address: in this browser at once, on the server a
// moment after the last change. The server may be away: then the browser's copy is what counts.

import { watch } from "/libraries/vue.js";
import { emptyDocument, readDocument } from "../document/document.js";
import { decode } from "../document/link.js";
import { edit, load, notify, select, state } from "../store.js";
import { t } from "../text/text.js";
import { loadDocument, saveDocument } from "./api.js";
import { readCopy, writeCopy } from "./copies.js";
import { loadLibrary, untilAnswered } from "./server.js";

const FIRST = "twist"; // the design that a first visitor sees
const SAVE_AFTER = 600; // ms after the last change
const COPY_AFTER = 150; // ms; a drag changes the document sixty times a second
const AGAIN = [1000, 30_000]; // ms until a failed save is tried again: at first, at most
const ID = /^\/d\/([A-Za-z0-9_-]{22})$/;

let revision = 0; // of the server's document that ours is based on; 0: it has none
let saved = null; // our document as the server has it, or as it was first shown
let sending = false;
let wait = AGAIN[0];
let timer = 0;
let copyTimer = 0;
let copies = true; // whether the browser keeps copies
let opened = 0; // rises when another document is opened: late answers about the one before are none

/** Save every change from now on. */
export function startSaving() {
  watch(() => [state.document, state.history], changed);
  globalThis.addEventListener("pagehide", leave);
  globalThis.addEventListener("online", saveNow);
  globalThis.addEventListener("popstate", openAddress);
  globalThis.addEventListener("hashchange", () => location.hash.startsWith("#design=") && openAddress());
}

/** Show the document that the page's address names: one that is saved, a shared one or the first. */
export async function openAddress() {
  const shared = /^#design=(.*)$/.exec(location.hash)?.[1];
  if (shared !== undefined) return openShared(shared);
  const id = ID.exec(location.pathname)?.[1] ?? null;
  if (id !== null && id === state.address) return undefined;
  return id === null ? openFirst() : openSaved(id);
}

async function openFirst() {
  const turn = begin(null);
  const designs = await loadLibrary();
  if (turn !== opened) return;
  const design = designs.find(({ name }) => name === FIRST) ?? designs[0];
  show(design ? { ...emptyDocument(), name: design.name, grid: design.grid } : emptyDocument());
}

async function openShared(text) {
  begin(null);
  history.replaceState(null, "", "/");
  try {
    show(await decode(text));
    saved = null; // the link is gone from the address: keep the design before it is changed
    changed();
  } catch (error) {
    state.dialog = { name: "message", title: t("common.linkBad"), text: error.message };
    await openFirst();
  }
}

async function openSaved(id) {
  const turn = begin(id);
  const copy = readCopy(id);
  if (copy) {
    revision = copy.revision;
    show(copy.document, copy.history, copy.saved ? copy.document : null);
  }
  let theirs = null;
  try {
    theirs = await untilAnswered(() => loadDocument(id));
  } catch (problem) {
    if (problem.status !== 404) state.problem = problem;
  }
  if (turn !== opened) return;
  if (theirs) reconcile(copy, theirs);
  else if (copy) again();
  else unknown();
}

/** Bring the browser's copy and the server's document together. */
function reconcile(copy, theirs) {
  let document;
  try {
    document = readDocument(theirs.document);
  } catch (error) {
    state.dialog = { name: "message", title: t("common.documentBad"), text: error.message };
    if (!copy) show(emptyDocument());
    return;
  }
  const changedHere = copy && (!copy.saved || state.document !== copy.document);
  if (copy && same(document, state.document)) accept(theirs.revision, state.document);
  else if (copy && theirs.revision === revision) changed();
  else if (changedHere) conflict({ revision: theirs.revision, document });
  else {
    revision = theirs.revision;
    show(document, undefined, document);
    accept(revision, document);
  }
}

function again() {
  revision = 0; // the server has lost it, or never had it
  saved = null;
  changed();
}

function unknown() {
  newDocument({ replace: true });
  state.dialog = { name: "message", title: t("common.unknownTitle"), text: t("common.unknownText") };
}

/** Begin a document without joints at an address of its own. */
export function newDocument({ replace = false } = {}) {
  const { grid: { material }, printer, materials } = state.document;
  begin(null);
  history[replace ? "replaceState" : "pushState"](null, "", "/");
  const empty = emptyDocument();
  show({ ...empty, printer, materials, grid: { ...empty.grid, material } });
}

/** Leave what is open; return a number that says which opening this is. */
function begin(id) {
  if (state.started) leave();
  clearTimeout(timer);
  clearTimeout(copyTimer);
  opened += 1;
  revision = 0;
  state.address = id;
  state.saving = "unsaved";
  return opened;
}

function show(document, past = undefined, asSaved = document) {
  saved = asSaved;
  load(document, past);
  select({});
  if (state.address !== null) state.saving = asSaved ? "saved" : "saving";
  state.started = true;
}

function changed() {
  if (state.address === null) {
    if (state.document === saved) return;
    state.address = newId();
    saved = null;
    history.replaceState(null, "", `/d/${state.address}`);
  }
  clearTimeout(copyTimer);
  copyTimer = setTimeout(keep, COPY_AFTER);
  if (state.saving === "conflict") return;
  if (state.document === saved) {
    saveNow(); // an edit was undone before it was sent
    return;
  }
  if (state.saving !== "offline") state.saving = "saving";
  clearTimeout(timer);
  timer = setTimeout(saveNow, SAVE_AFTER);
}

/** Keep a copy in this browser. */
function keep() {
  clearTimeout(copyTimer);
  if (state.address === null) return;
  const { address, document } = state;
  const kept = writeCopy(address, { revision, saved: document === saved, document, history: state.history });
  if (!kept && copies) notify(t("common.noStorage"));
  copies = kept;
}

/** Save the document on the server now, and again until it has it. */
export async function saveNow() {
  clearTimeout(timer);
  if (sending || state.address === null || state.saving === "conflict") return;
  if (state.document === saved) {
    state.saving = "saved";
    return;
  }
  sending = true;
  const turn = opened;
  const { address, document } = state;
  if (state.saving !== "offline") state.saving = "saving";
  try {
    const answer = await saveDocument(address, revision, document);
    if (turn === opened) accept(answer.revision, document);
  } catch (problem) {
    if (turn === opened) refused(problem, document);
  }
  sending = false;
  if (turn !== opened && state.document !== saved) saveNow();
}

function accept(number, document) {
  revision = number;
  saved = document;
  wait = AGAIN[0];
  state.connection = "online";
  keep();
  if (document === state.document) {
    state.saving = "saved";
  } else {
    state.saving = "saving";
    timer = setTimeout(saveNow, SAVE_AFTER);
  }
}

function refused(problem, document) {
  if (problem.status === 409 && problem.document) {
    if (same(problem.document, document)) accept(problem.revision, document);
    else conflict(problem);
    return;
  }
  if (problem.status === 404 && revision > 0) {
    revision = 0; // it was deleted on the server: save it again
    timer = setTimeout(saveNow, 0);
    return;
  }
  const later = problem.offline || problem.status >= 500 || problem.status === 429;
  if (problem.offline) state.connection = "offline";
  keep();
  state.saving = later && copies ? "offline" : "failed";
  if (!later) {
    notify(t("common.notSaved", { reason: problem.message }));
    return;
  }
  timer = setTimeout(saveNow, wait);
  wait = Math.min(2 * wait, AGAIN[1]);
}

let other = null; // { revision, document } of the server that ours is in conflict with

function conflict({ revision: number, document }) {
  keep();
  other = { revision: number, document };
  state.saving = "conflict";
  showConflict();
}

/** Show the choice between ours and the other document. */
export function showConflict() {
  state.dialog = { name: "conflict", theirs: other };
}

/** Settle a conflict: take the other document, as an edit that undo takes back. */
export function takeOther(theirs) {
  const document = readDocument(theirs.document);
  revision = theirs.revision;
  saved = document;
  state.saving = "saved";
  edit(() => document, { label: t("common.didTakeOther") });
  keep();
}

/** Settle a conflict: ours becomes a document of its own. */
export function keepMine() {
  opened += 1;
  state.address = newId();
  state.saving = "saving";
  revision = 0;
  saved = null;
  history.pushState(null, "", `/d/${state.address}`);
  keep();
  saveNow();
}

/** Save what can be saved while the page goes. */
function leave() {
  keep();
  if (state.address === null || state.document === saved || state.saving === "conflict") return;
  saveDocument(state.address, revision, state.document, { last: true }).catch(() => {
    // The browser's copy is what counts then: the next visit saves it.
  });
}

function newId() {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  const text = btoa(String.fromCharCode(...bytes));
  return text.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** Return whether two documents say the same. */
function same(a, b) {
  return JSON.stringify(ordered(a)) === JSON.stringify(ordered(b));
}

function ordered(value) {
  if (Array.isArray(value)) return value.map(ordered);
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.keys(value).sort().map((key) => [key, ordered(value[key])]));
}
