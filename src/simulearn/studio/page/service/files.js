// Files in and out: designs, drawings and surfaces of other programs, opening, dropping, pasting, saving,
// exporting, links.

import { emptyDocument, readDocument, sameGrid, sameMaterials, samePrinter } from "../document/document.js";
import { removeGoal } from "../document/goals.js";
import { encode } from "../document/link.js";
import { keepingSurfaces } from "../document/surfaces.js";
import { taskFile } from "../document/task.js";
import { edit, notify, select, state, undo } from "../store.js";
import { t } from "../text/text.js";
import { exportFile, openFile } from "./api.js";
import { download } from "./downloads.js";
import { showDrawing } from "./drawings.js";
import { chosenOwn, isMaterial, openMaterial } from "./materials.js";
import { isProfile, openProfile } from "./printers.js";
import { takeSurface } from "./surfaces.js";

const SURFACES = ".stl,.obj,.ply,.glb,.3dm";
const ENDINGS = `.json,.dxf,.svg,.csv,.txt,.html,.toml,${SURFACES},application/json,image/svg+xml`;
const LONG = 8000; // characters of a link that many programs do not pass on whole
const PASTED = [[/^<(svg|\?xml|!--)/, "common.pastedDrawing"], [/^[{[]/, "common.pasted"]]; // how it begins
const LATE = 300; // ms after which the page says that it reads a file
const MOST_PASTED = 4_000_000; // characters; the server takes no more either

/** Let the user choose a file, and open it. */
export function chooseFile() {
  choose(ENDINGS, {});
}

/** Let the user choose the file of a surface, and make it a goal. */
export function chooseSurface() {
  choose(SURFACES, { meant: "surface" });
}

function choose(accept, options) {
  const input = globalThis.document.createElement("input");
  Object.assign(input, { type: "file", accept });
  input.addEventListener("change", () => input.files.length && open(input.files[0], options));
  input.click();
}

let openings = 0; // only the last one counts

/** Replace the design by that of a file, as one edit; a profile or material takes the place of its like,
 * a surface becomes a goal.
 *
 * options: how a drawing is to be read; where its unit is not known, the page asks for it. replaces: the
 * name of the surface that is read again.
 */
export async function open(file, options = {}, replaces = null) {
  if (isProfile(file)) return (await isMaterial(file) ? openMaterial : openProfile)(file);
  openings += 1;
  const turn = openings;
  const late = setTimeout(() => { state.opening = file.name; }, LATE);
  let [found, document] = [null, null];
  try {
    found = await openFile(file, options);
    if (!found.surface) document = documentOf(found);
  } catch (problem) {
    if (turn === openings) refuse(file, problem, options, replaces);
    return null;
  } finally {
    clearTimeout(late);
    if (turn === openings) state.opening = null;
  }
  if (turn !== openings) return null;
  if (found.surface) return takeSurface(file, options, found, replaces);
  const { drawing, messages = [] } = found;
  const whole = found.kind === "document" || found.kind === "task"; // with its own goals, or none
  place(whole ? document : keepingSurfaces(state.document, document), t("common.didOpen", { file: file.name }));
  if (drawing) showDrawing(file, options, found);
  else if (messages.length) {
    const title = t("common.openNotes", { file: file.name });
    state.dialog = { name: "message", title, text: t("common.openMended"), messages };
  }
  return null;
}

/** Return the document of an opened file; a drawing keeps the material and the printer. */
function documentOf({ kind, grid, goals = [], surfaces = [], pose, name, printer, drawing, materials }) {
  const { schema } = emptyDocument();
  const { material } = drawing ? state.document.grid : grid;
  const by = printer || state.document.printer;
  const own = kind === "document" ? materials : state.document.materials;
  return readDocument({
    schema, name, grid: { ...grid, material }, goals, surfaces, pose, printer: by, materials: own,
  });
}

/** Say why a file cannot be opened, or ask for what is missing to open it. */
export function refuse(file, problem, options, replaces = null) {
  const { code, message, errors = [] } = problem;
  const reason = message.replace(/^[^:]*: /, ""); // the title names the file
  const ask = { reason, choose: (choice) => open(file, { ...options, ...choice }, replaces) };
  if (code === "surface-or-drawing") {
    state.dialog = { name: "which", file: file.name, choose: ask.choose };
    return;
  }
  if (code === "unit-unknown") {
    state.dialog = { name: "unit", file: file.name, size: problem.size, guess: problem.guess, ...ask };
    return;
  }
  if (code === "curves-only") {
    state.dialog = { name: "curves", file: file.name, ...ask };
    return;
  }
  const title = t("common.openFailed", { file: file.name });
  state.dialog = { name: "message", title, text: message, messages: errors };
}

/** Show another design in place of the current one; undo brings that back. */
export function place(document, label) {
  edit((before) => (sameGrid(before.grid, document.grid) && before.name === document.name
    && samePrinter(before.printer, document.printer) && sameMaterials(before, document)
    && document.goals.length === 0 && before.goals.length === 0 ? before : document), { label });
  select({});
  state.placed += 1;
  notify(t("common.placed", { name: document.name }), { label: t("common.undoWord"), run: undo });
}

/** Save the document as a file: all of it, or the grid alone as the command line reads it. */
export function saveFile({ gridOnly = false } = {}) {
  const { document } = state;
  const text = JSON.stringify(gridOnly ? document.grid : document, null, 1);
  download(new Blob([text], { type: "application/json" }), `${fileName()}${gridOnly ? ".grid" : ""}.json`);
}

/** Save grid, goals and surfaces as a task file, which the command line searches with. */
export function saveTask() {
  const { document } = state;
  const text = JSON.stringify(taskFile(document), null, document.surfaces.length ? 0 : 1);
  download(new Blob([text], { type: "application/json" }), `${fileName()}.task.json`);
  if (document.materials.length && chosenOwn() >= 0)
    notify(t("surface.taskMaterial", { name: document.grid.material }));
}

/** Save the result of an engine in one of the server's formats. */
export async function saveExport(format, engine) {
  const { grid, materials } = state.document;
  const { blob, name } = await exportFile(grid, format, { engine, name: fileName(), materials });
  download(blob, name);
}

/** Return the design's name as a file name without ending. */
export function fileName() {
  const plain = state.document.name.normalize("NFKD").replace(/[^\w-]+/g, "-").replace(/^-+|-+$/g, "");
  return plain.slice(0, 60) || "design";
}

/** Copy a link that holds the whole document; ask first where surfaces make it very long. */
export async function copyLink() {
  const link = `${location.origin}/#design=${await encode(state.document)}`;
  if (link.length <= LONG) return copy(link);
  const without = async () => copy(`${location.origin}/#design=${await encode(plain(state.document))}`);
  state.dialog = { name: "long", length: link.length, copy: () => copy(link), without };
  return null;
}

/** Return a document without the goals that have surfaces. */
function plain(document) {
  const names = document.surfaces.map(({ name }) => name);
  const named = ({ surface, away_from: body }) => names.includes(surface) || names.includes(body);
  return document.goals.reduceRight((before, goal, k) => (named(goal) ? removeGoal(before, k) : before), document);
}

async function copy(link) {
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
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    state.dropping = true;
  });
  globalThis.addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) state.dropping = false; // out of the window
  });
  globalThis.addEventListener("drop", (event) => {
    state.dropping = false;
    const [file] = event.dataTransfer?.files ?? [];
    if (!file) return;
    event.preventDefault();
    open(file);
  });
  globalThis.addEventListener("paste", (event) => {
    const text = event.clipboardData?.getData("text/plain").trim() ?? "";
    const typing = event.target.closest?.("input, textarea, dialog");
    const [, name] = PASTED.find(([start]) => start.test(text)) ?? [];
    if (typing || !name || text.length > MOST_PASTED) return;
    event.preventDefault();
    open(new File([text], t(name)));
  });
}
