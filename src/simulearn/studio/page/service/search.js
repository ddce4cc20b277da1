// The automatic search: begun for a document, followed in the background, its result kept until it is
// taken or discarded. state.search has
//   document: that it is for, until: seconds that it may take,
//   state: "queued", "running", "stopping", "done", "failed", lost: whether the server is silent,
//   steps: {iteration, phase, seconds, designs, error_mm, grid} so far,
//   best: {grid, error_mm, error_fea_mm, ...} once it is done, problem: why it failed.

import { taskOf } from "../document/task.js";
import { state } from "../store.js";
import { Problem, jobFrames, simulate, startOptimize } from "./api.js";
import { placedLike, withDesign } from "./designs.js";
import { runJob } from "./jobs.js";
import { latest } from "./latest.js";
import { endPreview, showPreview } from "./preview.js";

const SHOWN = 60; // steps at most that are stepped through; of more, every second or third is left out
const SHAPES = latest(0);

let job = null;

/** Begin to search for a design that comes closer to the goals; an earlier search is forgotten. */
export async function startSearch({ joints, actuators, seconds }) {
  discardSearch();
  const { document } = state;
  const free = { ...(joints ? {} : { joints: [] }), ...(actuators ? {} : { actuators: [] }) };
  const task = taskOf(document, { free, limits: { seconds } });
  const key = {}; // of this search: answers to an earlier one are left unread
  state.search = { key, document, until: seconds, state: "queued", lost: false, steps: [], seconds: 0 };
  const update = (more) => {
    if (state.search?.key === key) state.search = { ...state.search, ...more };
  };
  job = runJob(() => startOptimize(task), (answer) => {
    const now = state.search?.state === "stopping" ? "stopping" : answer.state;
    update({
      state: ["queued", "stopping"].includes(now) ? now : "running",
      steps: answer.steps, seconds: answer.seconds, lost: answer.lost,
    });
  });
  try {
    const answer = await job.finished;
    if (!answer.result) return update({ state: "cancelled" });
    const best = { ...answer.result, grid: placedLike(document.grid, answer.result.grid) };
    const [shape] = await shapes(answer.id);
    update({ state: "done", best, shape, stages: stagesOf(document, answer.steps, best, shape) });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    update({ state: "failed", problem });
  }
  return null;
}

/** Return the shapes of a search's result; without them it is simulated when it is looked at. */
async function shapes(id) {
  try {
    return (await jobFrames(id)).map((result) => (result.ok ? result : null));
  } catch {
    return [null, null];
  }
}

/** End the search; the best so far is its result. */
export function stopSearch() {
  job?.cancel();
  if (state.search) state.search = { ...state.search, state: "stopping" };
}

/** Forget the search and what it found. */
export function discardSearch() {
  if (searching()) job.cancel();
  endPreview("search");
  job = null;
  state.search = null;
}

/** Return whether a search is going on. */
export function searching() {
  return ["queued", "running", "stopping"].includes(state.search?.state);
}

/** Return the designs on the way of a search, each different from the one before; the best is last. */
function stagesOf(document, steps, best, shape) {
  const changed = steps.filter((step, n) => n === 0 || differs(step.grid, steps[n - 1].grid));
  const stride = Math.ceil(changed.length / SHOWN);
  const stages = changed.filter((step, n) => n % stride === 0).map((step) => ({
    grid: placedLike(document.grid, step.grid), error: step.error_mm, designs: step.designs, result: null,
  }));
  const last = { grid: best.grid, error: best.error_mm, designs: best.designs, result: shape };
  if (stages.length && !differs(stages.at(-1).grid, best.grid)) stages.pop();
  return [...stages, last];
}

function differs(a, b) {
  return a.joints.some(([x, y], k) => x !== b.joints[k][0] || y !== b.joints[k][1])
    || a.actuators.some((ratio, k) => ratio !== b.actuators[k]);
}

/** Show a stage of the search in the scene. */
export function showStage(stage, label) {
  const { search } = state;
  const show = () => showPreview("search", {
    result: stage.result, label, document: withDesign(search.document, search.document, stage.grid),
  });
  if (stage.result) {
    SHAPES.drop();
    return show();
  }
  return SHAPES.ask((signal) => simulate([stage.grid], { signal }), (results) => {
    if (!results?.[0].ok) return;
    [stage.result] = results;
    if (state.search?.stages?.includes(stage)) show();
  });
}

/** Stop showing a stage. */
export function hideStage() {
  SHAPES.drop();
  endPreview("search");
}
