// Files in and out: opening, dropping, pasting, saving, exporting, links.

import { emptyDocument, readDocument, sameGrid } from "../document/document.js";
import { encode } from "../document/link.js";
import { edit, notify, select, state, undo } from "../store.js";
import { t } from "../text/text.js";
import { exportFile, openFile } from "./api.js";

const ENDINGS = ".json,application/json";
const MOST_PASTED = 4_000_000; // characters; the server takes no more either

/** Let the user choose a file, and open it. */
export function chooseFile() {
  const input = globalThis.document.createElement("input");
  Object.assign(input, { type: "file", accept: ENDINGS });
  input.addEventListener("change", () => input.files.length && open(input.files[0]));
  input.click();
}

/** Replace the design by that of a file, as one edit. */
export async function open(file) {
  let found;
  try {
    found = await openFile(file);
  } catch (problem) {
    refuse(file, problem);
    return;
  }
  const { grid, goals = [], name, messages = [], printer } = found;
  let document;
  try {
    const { schema } = emptyDocument();
    document = readDocument({ schema, name, grid, goals, printer: printer || state.document.printer });
  } catch (error) {
    refuse(file, error);
    return;
  }
  place(document, t("common.didOpen", { file: file.name }));
  if (messages.length) {
    const title = t("common.openNotes", { file: file.name });
    state.dialog = { name: "message", title, text: t("common.openMended"), messages };
  }
}

function refuse(file, { message, errors = [] }) {
  const title = t("common.openFailed", { file: file.name });
  state.dialog = { name: "message", title, text: message, messages: errors };
}

/** Show another design in place of the current one; undo brings that back. */
export function place(document, label) {
  edit((before) => (sameGrid(before.grid, document.grid) && before.name === document.name
    && document.goals.length === 0 && before.goals.length === 0 ? before : document), { label });
  select({});
  notify(t("common.placed", { name: document.name }), { label: t("common.undoWord"), run: undo });
}

/** Save the document as a file: all of it, or the grid alone as the command line reads it. */
export function saveFile({ gridOnly = false } = {}) {
  const { document } = state;
  const text = JSON.stringify(gridOnly ? document.grid : document, null, 1);
  download(new Blob([text], { type: "application/json" }), `${fileName()}${gridOnly ? ".grid" : ""}.json`);
}

/** Save the result of an engine in one of the server's formats. */
export async function saveExport(format, engine) {
  const { blob, name } = await exportFile(state.document.grid, format, { engine, name: fileName() });
  download(blob, name);
}

/** Return the design's name as a file name without ending. */
export function fileName() {
  const plain = state.document.name.normalize("NFKD").replace(/[^\w-]+/g, "-").replace(/^-+|-+$/g, "");
  return plain.slice(0, 60) || "design";
}

function download(blob, name) {
  const link = globalThis.document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // ms; the browser has read it by then
  notify(t("common.downloaded", { file: name }));
}

/** Copy a link that holds the whole document. */
export async function copyLink() {
  const link = `${location.origin}/#design=${await encode(state.document)}`;
  try {
    await navigator.clipboard.writeText(link);
    notify(t("common.linkCopied"));
  } catch {
    state.dialog = { name: "link", link }; // no clipboard without https or permission
  }
}

/** Open files that are dropped on the page, and pasted text that is a design. */
export function startFiles() {
  globalThis.addEventListener("dragover", (event) => {
    if (event.dataTransfer?.types.includes("Files")) event.preventDefault();
  });
  globalThis.addEventListener("drop", (event) => {
    const [file] = event.dataTransfer?.files ?? [];
    if (!file) return;
    event.preventDefault();
    open(file);
  });
  globalThis.addEventListener("paste", (event) => {
    const text = event.clipboardData?.getData("text/plain").trim() ?? "";
    const typing = event.target.closest?.("input, textarea, dialog");
    if (typing || !text.startsWith("{") || text.length > MOST_PASTED) return;
    event.preventDefault();
    open(new File([text], t("common.pasted")));
  });
}
