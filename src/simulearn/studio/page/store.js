// The state of the page: one document, its history, and what the server said about it.
// The document is never changed in place; `edit` replaces it and remembers the one before.

import { computed, reactive, shallowReactive } from "/libraries/vue.js";
import { emptyDocument } from "./document/document.js";
import { emptyHistory, record, redone, undone } from "./document/history.js";

export const state = shallowReactive({
  document: emptyDocument(),
  history: emptyHistory(),
  selection: { joints: [], beams: [] }, // and perhaps goal; numbers in the document; replaced, never changed in place
  hover: null, // { joint } or { beam } or { goal }: what the pointer or focus is on, in any view
  tool: "select", // select, draw, split, fix
  tab: "design", // design, goals, check, print
  answer: null, // { document, result, milliseconds }: the last result, perhaps of an earlier document
  check: null, // { document, errors, warnings, netLengths } of the last answer or failure
  busy: false, // whether the server is asked about the current document
  problem: null, // why the last question had no answer: a Problem
  preview: null, // { result, grid, label }: a suggestion or step shown in place of the answer
  fea: null, // { document, result, seconds, progress, state }: of the check by finite elements
  spread: null, // { document, state, result, problem }: how prints differ; see service/spread.js
  print: null, // { document, toolpath, facts, layer, travels }: of the tab "print"
  library: [], // [{ name, description, grid }]
  material: null, // { name, section: {width, thickness}, limits: {...}, ... } of the grid's; see service/materials.js
  connection: "online", // online, offline
  saving: "unsaved", // unsaved (nothing to save yet), saved, saving, offline, conflict, failed
  address: null, // id of the document in the page's address; null until there is something to save
  started: false, // whether there is a document to show
  server: null, // { version, ready, engines, formats, model } as the server says
  pointer: null, // [x, y] in mm under the pointer, where the plan gives it
  dialog: null, // { name, ... }: the open dialog and what it is about
  pickVertex: null, // function: the shape view calls it with the vertex that is picked next
  suggestions: null, // { document, state, error, cards, problem }: single changes; see service/suggestions.js
  measured: null, // { document, result, shapes, ... }: the shape against its goals; see service/measuring.js
  spots: null, // [[x, y, z]] of a surface, which the scene shows while a panel speaks of them
  search: null, // { document, state, steps, result, ... }: the automatic search; see service/search.js
  drawingShown: false, // whether the panel is open that tells how the document came out of a drawing
  places: null, // { points: [[x, y]], current }: where the plan shows what a panel speaks of
  placed: 0, // rises when another design takes the place of the shown one: the views show all of it
  opening: null, // name of the file that is being read
  dropping: false, // whether a file is held over the page
  notices: [], // [{ id, text, action: { label, run } | null }]: short confirmations
});

/** What is shown and how; not part of the document. */
export const view = reactive({
  frame: 11, // 0 to 11, fractions between frames while playing
  playing: false,
  loop: true,
  colour: "actuator", // actuator, stress, strain, height, deviation
  ghost: true,
  dimensions: false,
  heights: false,
  theme: "system", // system, light, dark
  language: "en",
  pane: "both", // plan, shape, both; narrow windows show one
  share: 0.5, // part of the width that the plan has beside the shape
  side: true, // whether the side panel is open
  ground: true, // whether the shape stands over a grid
  parallel: false, // whether the shape is seen in parallel projection
  overlay: true, // whether the tab "check" lays the finite elements' shape over the shown one
  tip: true, // whether the line for the first minute is shown
});

/** Whether the shown answer belongs to an earlier document. */
export const stale = computed(() => state.answer?.document.grid !== state.document.grid);

/** Return whether the server compiles its model, as it does the first time on a machine. */
export function preparing() {
  return state.server !== null && !state.server.ready;
}

/** Replace the document by change(document).
 *
 * label: what was done, for undo. merge: edits in a row with the same key are one step of undo, as
 * the moves of one drag. A change that returns the same document is none.
 */
export function edit(change, { label, merge = null }) {
  const next = change(state.document);
  if (next === state.document) return;
  state.history = record(state.history, state.document, label, merge);
  show(next);
}

/** End a run of merged edits, as at the end of a drag. */
export function endMerge() {
  state.history = { ...state.history, merge: null };
}

export function undo() {
  step(undone(state.history, state.document));
}

export function redo() {
  step(redone(state.history, state.document));
}

function step(result) {
  if (!result) return;
  state.history = result.history;
  show(result.document);
}

/** Replace document and history, as when a file is opened or a page is loaded. */
export function load(document, history = emptyHistory()) {
  state.history = history;
  show(document);
}

export function select(selection) {
  state.selection = { joints: [], beams: [], ...selection };
}

function show(document) {
  state.document = document;
  const { joints, beams } = document.grid;
  const { selection } = state;
  if (selection.joints.some((k) => k >= joints.length) || selection.beams.some((b) => b >= beams.length))
    select({
      joints: selection.joints.filter((k) => k < joints.length),
      beams: selection.beams.filter((b) => b < beams.length),
    });
}

let notices = 0;

/** Show a short confirmation, with something to do about it: { label, run }. */
export function notify(text, action = null) {
  notices += 1;
  state.notices = [...state.notices.slice(-2), { id: notices, text, action }];
}

export function dismiss(id) {
  state.notices = state.notices.filter((notice) => notice.id !== id);
}
