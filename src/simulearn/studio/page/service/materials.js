// Materials: those that the server knows, and files that people open. A file is kept in the document
// as text, so that a link, a file and the server's copy can be simulated without it.

import { shallowRef, watch, watchEffect } from "/libraries/vue.js";
import { MOST_MATERIALS, MOST_PROFILE, USUAL_MATERIAL } from "../document/document.js";
import { edit, notify, state, undo } from "../store.js";
import { t } from "../text/text.js";
import { Problem, materials as ofServer, materialText, readMaterials } from "./api.js";
import { download } from "./downloads.js";
import { untilAnswered } from "./server.js";

const OF_MATERIAL = /^\s*\[shrinkage\]/m; // which no printer's profile has

/** Materials of the server, once it has answered. */
export const known = shallowRef([]);

/** Of the document's own: { texts, facts: of each, problem }; texts are the document's. */
export const own = shallowRef({ texts: [], facts: [], problem: null });

const read = new Map(); // text -> what the server has said of it

/** Keep `state.material` that of the grid, and ask the server what it does not know yet. */
export async function startMaterials() {
  watchEffect(() => {
    const { grid } = state.document;
    state.material = all().find(({ name }) => name === grid.material) ?? null;
  });
  watch(() => state.document.materials, askOwn, { immediate: true, flush: "sync" });
  known.value = (await untilAnswered(ofServer)).materials;
}

/** Return what is known of all materials that the grid may name. */
export function all() {
  return [...known.value, ...own.value.facts];
}

/** Return which of the document's own materials the grid's is, -1 where it is none of them. */
export function chosenOwn() {
  return own.value.facts.findIndex(({ name }) => name === state.document.grid.material);
}

/** Ask what the texts of the document's own materials say, unless it is known. */
async function askOwn() {
  const { materials: texts } = state.document;
  const facts = texts.map((text) => read.get(text));
  const complete = facts.every(Boolean);
  own.value = { texts, facts: complete ? facts : [], problem: null };
  if (complete) return;
  let [found, problem] = [[], null];
  try {
    found = (await untilAnswered(() => readMaterials(texts))).materials;
  } catch (refusal) {
    problem = refusal;
  }
  found.forEach((one, k) => read.set(texts[k], one));
  if (own.value.texts === texts) own.value = { texts, facts: found, problem };
}

/** Make the grid of another material: one of the server, or the document's. */
export function chooseMaterial(name) {
  const { title } = all().find((one) => one.name === name);
  edit((document) => ({ ...document, grid: { ...document.grid, material: name } }), {
    label: t("material.did", { title }),
  });
}

/** Let the user choose a material's file, and open it. */
export function chooseMaterialFile() {
  const input = globalThis.document.createElement("input");
  Object.assign(input, { type: "file", accept: ".toml" });
  input.addEventListener("change", () => input.files.length && openMaterial(input.files[0]));
  input.click();
}

/** Return whether a file of TOML is a material, by what it holds. */
export async function isMaterial(file) {
  return file.size <= 4 * MOST_PROFILE && OF_MATERIAL.test(await file.text());
}

/** Make the grid of the material in a file, or say what is wrong with it and where.
 *
 * It takes the place of the document's material of the same name.
 */
export async function openMaterial(file) {
  try {
    if (file.size > 4 * MOST_PROFILE) // bytes: no letter has more
      throw new Problem({ detail: t("material.large", { most: MOST_PROFILE }) });
    const text = await file.text();
    const [facts] = (await readMaterials([text])).materials;
    const rest = state.document.materials.filter((one) => read.get(one)?.name !== facts.name);
    if (rest.length >= MOST_MATERIALS)
      throw new Problem({ detail: t("material.many", { most: MOST_MATERIALS }) });
    read.set(text, facts);
    change([...rest, text], facts.name, t("material.did", { title: facts.title }));
    notify(t("material.opened", { title: facts.title }), { label: t("common.undoWord"), run: undo });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    const title = t("common.openFailed", { file: file.name });
    state.dialog = { name: "message", title, text: problem.message };
  }
}

/** Take the grid's own material out of the document; the grid is of the usual one then. */
export function removeMaterial() {
  const { texts, facts } = own.value;
  const k = chosenOwn();
  if (k < 0) return;
  change(texts.toSpliced(k, 1), USUAL_MATERIAL, t("material.didRemove", { title: facts[k].title }));
}

/** Have the browser save the text of the grid's material, to be changed. */
export async function saveMaterial() {
  const { material } = state.document.grid;
  const k = chosenOwn();
  const text = k < 0 ? await materialText(material) : own.value.texts[k];
  download(new Blob([text], { type: "application/toml" }), `${material.replace(/[^\w-]+/g, "-")}.toml`);
}

/** Replace the document's materials. The grid is a new one even where the name stays: it is simulated again. */
function change(materials, material, label) {
  edit((document) => ({ ...document, materials, grid: { ...document.grid, material } }), { label });
}
