// Printers: those that the server knows, and profiles that people open. A profile is kept in the
// document as text, so that a link, a file and the server's copy can be printed without the file.

import { shallowRef } from "/libraries/vue.js";
import { MOST_PROFILE } from "../document/document.js";
import { edit, notify, state, undo, view } from "../store.js";
import { t } from "../text/text.js";
import { Problem, printers, profileText, readProfile } from "./api.js";
import { download } from "./downloads.js";
import { untilAnswered } from "./server.js";

/** Printers of the server, once they are asked for. */
export const known = shallowRef([]);

/** Of the document's own profile: { printer, facts, problem }; printer is the document's. */
export const own = shallowRef({ printer: null, facts: null, problem: null });

export async function fetchPrinters() {
  if (known.value.length === 0) known.value = (await untilAnswered(printers)).printers;
}

/** Return what is known of the document's printer, or null. */
export function printerFacts() {
  const { printer } = state.document;
  if (typeof printer === "string") return known.value.find(({ name }) => name === printer) ?? null;
  return own.value.printer === printer ? own.value.facts : null;
}

/** Ask what the document's own profile says, unless it is known. */
export async function askOwn() {
  const { printer } = state.document;
  if (typeof printer === "string" || own.value.printer === printer) return;
  own.value = { printer, facts: null, problem: null };
  let [facts, problem] = [null, null];
  try {
    facts = await untilAnswered(() => readProfile(printer.profile));
  } catch (refusal) {
    problem = refusal;
  }
  if (own.value.printer === printer) own.value = { printer, facts, problem };
}

/** Print on a printer of the server. */
export function choosePrinter(name) {
  const { title } = known.value.find((one) => one.name === name);
  change(name, title);
}

/** Let the user choose a profile, and open it. */
export function chooseProfile() {
  const input = globalThis.document.createElement("input");
  Object.assign(input, { type: "file", accept: ".toml" });
  input.addEventListener("change", () => input.files.length && openProfile(input.files[0]));
  input.click();
}

/** Return whether a file is a printer's profile, by its name. */
export function isProfile({ name }) {
  return /\.toml$/i.test(name);
}

/** Print on the printer of a profile, or say what is wrong with it and where. */
export async function openProfile(file) {
  try {
    if (file.size > 4 * MOST_PROFILE) // bytes: no letter has more
      throw new Problem({ detail: t("print.profileLarge", { most: MOST_PROFILE }) });
    const profile = await file.text();
    const facts = await readProfile(profile);
    const printer = { profile };
    own.value = { printer, facts, problem: null };
    change(printer, facts.title);
    [state.tab, view.side] = ["print", true];
    notify(t("print.profileOpened", { title: facts.title }), { label: t("common.undoWord"), run: undo });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    const title = t("common.openFailed", { file: file.name });
    state.dialog = { name: "message", title, text: problem.message };
  }
}

/** Have the browser save the profile of the document's printer, to be changed. */
export async function saveProfile() {
  const { printer } = state.document;
  const named = typeof printer === "string";
  const text = named ? await profileText(printer) : printer.profile;
  const name = printerFacts()?.name ?? "printer";
  download(new Blob([text], { type: "application/toml" }), `${name.replace(/[^\w-]+/g, "-")}.toml`);
}

function change(printer, title) {
  edit((document) => ({ ...document, printer }), { label: t("print.didPrinter", { printer: title }) });
}
