// Questions to the server. Every function returns what was asked for, or throws a Problem.

import { patternOf } from "../document/imported.js";
import { MEDIA_TYPE, parseFrames } from "./frames.js";

/** Why the server did not answer a question; `code` and `where` are for programs.
 *
 * revision and document: the newer one of a document that was changed elsewhere. size and guess: of a
 * drawing whose unit is not known.
 */
export class Problem extends Error {
  constructor({
    status = 0, code = "", where = "", detail = "", errors = [], revision, document, size, guess,
  }) {
    super(detail);
    Object.assign(this, { status, code, where, errors, revision, document, size, guess });
  }

  /** Whether the server was not reached at all. */
  get offline() {
    return this.status === 0;
  }
}

async function request(path, { method = "GET", body, accept = "application/json", signal, keepalive } = {}) {
  let response;
  try {
    response = await fetch(path, {
      method,
      signal,
      keepalive,
      headers: { Accept: accept, ...(body === undefined ? {} : { "Content-Type": "application/json" }) },
      body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Problem({ detail: "The server does not answer.", code: "offline" });
  }
  if (response.ok) return response;
  let problem = {};
  try {
    problem = await response.json();
  } catch {
    problem = { detail: `The server answered with status ${response.status}.` };
  }
  throw new Problem({ ...problem, status: response.status });
}

const json = async (path, options) => (await request(path, options)).json();
const post = (path, body, signal) => json(path, { method: "POST", body, signal });

export const version = () => json("/api/version");
export const library = () => json("/api/library");
export const materials = () => json("/api/materials");

/** Return the materials that texts describe, or the text of a material of the server. */
export const readMaterials = (texts) => post("/api/materials", { materials: texts });
export const materialText = async (name) => (await request(`/api/materials/${name}`, { accept: "*/*" })).text();
export const printers = () => json("/api/printers");

// The texts of materials that grids may name, where there are any.
const ownMaterials = (texts) => (texts?.length ? { materials: texts } : {});

/** Return the results of grids, as `parseFrames` gives them; each has its `grid`, to be drawn by. */
export async function simulate(grids, { engine = "learned", materials: texts, prints = 0, signal } = {}) {
  const response = await request("/api/simulate", {
    method: "POST", body: { grids, engine, ...ownMaterials(texts), ...(prints ? { prints } : {}) }, accept: MEDIA_TYPE, signal,
  });
  return parseFrames(await response.arrayBuffer()).map((result, k) => ({ ...result, grid: grids[k] }));
}

export const rank = (task, signal) => post("/api/rank", task, signal);

/** Return how far shapes { joints, beams } are from the goals of a task. */
export const measure = (task, shapes) => post("/api/measure", { task, shapes });

/** Return the printer that the text of a profile describes, or the text of a printer's profile. */
export const readProfile = (profile) => post("/api/profile", { profile });
export const profileText = async (name) => (await request(`/api/printers/${name}`, { accept: "*/*" })).text();

// A printer is a name, or { profile: text }.
const by = (printer) => (typeof printer === "string" ? { printer } : printer);
const printOf = ([grids, printer, texts]) => ({ grids, ...by(printer), ...ownMaterials(texts) });

/** A print is [grids, printer, texts of materials]. */
export const toolpath = (print, signal) => post("/api/toolpath", printOf(print), signal);

/** Return the file that prints grids: a Blob and its name. */
export async function printFile(print, names, format) {
  const response = await request("/api/gcode", {
    method: "POST", body: { ...printOf(print), names, format }, accept: "text/x.gcode, model/3mf",
  });
  return { blob: await response.blob(), name: fileNameOf(response) ?? `grid.${format}` };
}

export const startOptimize = (task) => post("/api/optimize", task);
export const startFea = (grids, texts) => post("/api/fea", { grids, ...ownMaterials(texts) });

/** Return how far a job is, with the steps that are new after the first `since`. */
export const job = (id, { since = 0 } = {}) => json(`/api/jobs/${id}?since=${since}`);
export const cancelJob = (id) => request(`/api/jobs/${id}`, { method: "DELETE" });

/** Return the results of a job that is done, as `parseFrames` gives them. */
export async function jobFrames(id) {
  const response = await request(`/api/jobs/${id}/frames`, { accept: MEDIA_TYPE });
  return parseFrames(await response.arrayBuffer());
}

export const loadDocument = (id) => json(`/api/documents/${id}`);

/** Save a document that is based on a revision; last: the page is about to go. */
export const saveDocument = (id, revision, document, { last = false } = {}) =>
  json(`/api/documents/${id}`, { method: "PUT", body: { revision, document }, keepalive: last });

/** Return {grid, goals, name, messages, drawing} of a file that the user opens, or {name, surface}.
 *
 * options: how a drawing is to be read: { unit, width, layers, flatten, actuators, tolerance, without };
 * those that are null are left to the server. layers are names. meant: "drawing" or "surface".
 */
export async function openFile(file, options = {}) {
  const query = new URLSearchParams({ name: file.name });
  const layers = options.layers?.map(patternOf);
  for (const [key, value] of Object.entries({ ...options, layers }))
    for (const one of [value ?? []].flat()) query.append(key, one);
  let response;
  try {
    response = await fetch(`/api/open?${query}`, {
      method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: file,
    });
  } catch {
    throw new Problem({ detail: "The server does not answer.", code: "offline" });
  }
  const answer = await response.json();
  if (!response.ok) throw new Problem({ ...answer, status: response.status });
  return answer;
}

/** Return a file of a result: a Blob and its name. */
export async function exportFile(grid, format, { engine = "learned", name = "grid", materials: texts } = {}) {
  const response = await request("/api/export", {
    method: "POST", body: { grid, format, engine, name, ...ownMaterials(texts) }, accept: "*/*",
  });
  return { blob: await response.blob(), name: fileNameOf(response) ?? `${name}${format}` };
}

/** Return the file name that an answer has in its header; several files come as one .zip. */
function fileNameOf(response) {
  const encoded = /filename\*=UTF-8''([^;]+)/.exec(response.headers.get("Content-Disposition") ?? "")?.[1];
  return encoded === undefined ? null : decodeURIComponent(encoded);
}
