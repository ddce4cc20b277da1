// Jobs outlive the page: a search or check that was begun, or whose result was not yet taken, is found
// again when the page is loaded anew in the same tab. The tab's storage keeps its name and its document.

import { watch } from "/libraries/vue.js";
import { readDocument, sameGrid, sameMaterials } from "../document/document.js";
import { state } from "../store.js";
import { job as question } from "./api.js";
import { resumeCheck } from "./checking.js";
import { resumeSearch } from "./search.js";

const KEY = "simulearn.jobs";
const OVER = ["failed", "cancelled"]; // nothing more will come of it
const RESUME = { search: resumeSearch, fea: resumeCheck };

/** Keep track of jobs, and follow those again that the page followed before. */
export function startResuming() {
  const stop = watch(() => state.started, () => {
    if (!state.started) return;
    stop();
    for (const [name, job] of Object.entries(read())) resume(name, job);
    watch(() => [state.address, state.search?.id, state.search?.state, state.fea?.id, state.fea?.state], keep);
  }, { flush: "sync" });
}

/** Follow a job; one that was done is forgotten where the server has forgotten it. */
async function resume(name, job) {
  try {
    if (job.done) await question(job.id, { since: Number.MAX_SAFE_INTEGER });
  } catch (problem) {
    if (problem.status === 404) return;
  }
  RESUME[name]?.({ ...job, document: known(job.document) });
}

/** Return the jobs of the design that is open. */
function read() {
  try {
    const { address, jobs } = JSON.parse(sessionStorage.getItem(KEY));
    if (address !== state.address) return {};
    return Object.fromEntries(Object.entries(jobs).map(([name, job]) => (
      [name, { ...job, document: readDocument(job.document) }])));
  } catch {
    return {}; // none, no storage, or of a page that wrote something else
  }
}

/** Return the open document where a job is about its grid: then it is not of an earlier design. */
function known(document) {
  const alike = sameGrid(document.grid, state.document.grid) && sameMaterials(document, state.document)
    && wishes(document) === wishes(state.document);
  return alike ? state.document : document;
}

const wishes = ({ goals, surfaces, pose }) => JSON.stringify([goals, surfaces, pose]);

function keep() {
  const jobs = {};
  for (const name of Object.keys(RESUME)) {
    const { id, state: now, document, until } = state[name] ?? {};
    if (id && !OVER.includes(now)) jobs[name] = { id, document, until, done: now === "done" };
  }
  try {
    sessionStorage.setItem(KEY, JSON.stringify({ address: state.address, jobs }));
  } catch {
    // Without storage a reload begins anew.
  }
}
