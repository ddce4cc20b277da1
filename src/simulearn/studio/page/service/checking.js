// The check by finite elements, in the background while the design may be changed further.
// state.fea has document, reference: the engine's result that is checked, result: by finite elements,
// id: of the job, seconds, progress: [done, total] frames, state: "queued", "running", "done", "failed",
// "cancelled", lost: whether the server is silent, problem or message and hint: why it failed.

import { state } from "../store.js";
import { Problem, jobFrames, simulate, startFea } from "./api.js";
import { runJob } from "./jobs.js";
import { accept } from "./simulation.js";

const FAILED = { code: "no-shapes" };

let job = null;

/** Begin to check the current design. */
export function startCheck() {
  const { document, answer } = state;
  const reference = answer?.document.grid === document.grid ? answer.result : null;
  return follow(document, reference, () => startFea([document.grid], document.materials));
}

/** Follow a check again that the page followed before it was loaded anew. */
export async function resumeCheck({ id, document }) {
  let reference = null;
  try {
    const [result] = await simulate([document.grid], { materials: document.materials });
    if (result.ok) reference = result;
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem; // without it the shapes are not compared
  }
  if (state.fea === null) await follow(document, reference, async () => ({ job: id }));
}

async function follow(document, reference, begin) {
  cancelCheck();
  const key = {}; // of this check: answers to an earlier one are left unread
  state.fea = {
    key, document, reference, result: null, state: "queued", lost: false, progress: null, seconds: 0,
  };
  const update = (more) => {
    if (state.fea?.key === key) state.fea = { ...state.fea, ...more };
  };
  job = runJob(begin, ({ id, state: now, progress, seconds, lost }) => update({
    id,
    state: now === "queued" ? "queued" : "running",
    progress: progress && [progress.done, progress.total], seconds, lost,
  }));
  try {
    const end = await job.finished;
    if (end.state === "cancelled") return update({ state: "cancelled" });
    const [result] = await frames(end.id);
    if (!result) return update({ state: "failed", problem: new Problem(FAILED) });
    if (!result.ok) return update({ state: "failed", message: result.message, hint: result.hint });
    update({ state: "done", result, seconds: end.seconds });
    // Where the model has no shape, as of a material that it has not learnt, this is the design's.
    if (!reference && document.grid === state.document.grid) accept(document, result, 1000 * end.seconds);
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    update({ state: "failed", problem });
  }
  return null;
}

/** Stop the check that is going on, or forget the last one. */
export function cancelCheck() {
  if (checking()) job.cancel();
  job = null;
  state.fea = null;
}

/** Return whether a check is going on. */
export function checking() {
  return ["queued", "running"].includes(state.fea?.state);
}

async function frames(id) {
  for (let tries = 0; ; tries += 1) {
    try {
      return await jobFrames(id);
    } catch (problem) {
      if (!problem.offline || tries === 4) throw problem;
      await new Promise((resolve) => { setTimeout(resolve, 1000); });
    }
  }
}
