// The automatic search: begun for a document, followed in the background, its result kept until it is
// taken or discarded. state.search has
//   document: that it is for, until: seconds that it may take,
//   state: "queued", "running", "stopping", "done", "failed", lost: whether the server is silent,
//   id: of the job, once the server has taken it,
//   passed: seconds since it began, 0 while it gets ready,
//   steps: {iteration, phase, seconds, designs, error_mm, grid} so far,
//   best: {grid, error_mm, error_fea_mm, ...} and stages on the way there once it is done,
//   answers: designs that differ, where more than one was wanted and found,
//   problem: why it failed or ended early.

import { taskOf } from "../document/task.js";
import { state } from "../store.js";
import { Problem, jobFrames, simulate, startOptimize } from "./api.js";
import { placedLike, withDesign } from "./designs.js";
import { runJob } from "./jobs.js";
import { latest } from "./latest.js";
import { answersOf, bestOf, stagesOf } from "./steps.js";
import { endPreview, showPreview } from "./preview.js";

const SHAPES = latest(0);
const SEVERAL = 3; // limits of time that several answers may take

let job = null;

/** Begin to search for a design that comes closer to the goals; an earlier search is forgotten. */
export function startSearch({ joints, actuators, seconds, answers }) {
  const { document } = state;
  const free = { ...(joints ? {} : { joints: [] }), ...(actuators ? {} : { actuators: [] }) };
  const limits = answers > 1 ? { seconds, answers } : { seconds };
  const task = taskOf(document, { free, limits });
  return follow(document, seconds * timesAsLong(answers), () => startOptimize(task));
}

/** Return how many times the limit a search for so many answers may take, as the server has it. */
export const timesAsLong = (answers) => (answers > 1 ? SEVERAL : 1);

/** Follow a search again that the page followed before it was loaded anew. */
export function resumeSearch({ id, document, until }) {
  return follow(document, until, async () => ({ job: id }));
}

async function follow(document, seconds, begin) {
  discardSearch();
  const key = {}; // of this search: answers to an earlier one are left unread
  state.search = { key, document, until: seconds, state: "queued", lost: false, steps: [], passed: 0 };
  const update = (more) => {
    if (state.search?.key === key) state.search = { ...state.search, ...more };
  };
  let ready = null; // s after which the search itself began: kernels are compiled before
  job = runJob(begin, ({ id, state: now, steps, seconds: passed, lost }) => {
    if (steps.length) ready ??= passed - steps.at(-1).seconds;
    const stopping = state.search?.state === "stopping";
    update({
      state: stopping ? "stopping" : now === "queued" ? now : "running",
      id, steps, lost, passed: ready === null ? 0 : passed - ready,
    });
  });
  try {
    const answer = await job.finished;
    if (!answer.result) return update({ state: "cancelled" });
    const best = { ...answer.result, grid: placedLike(document.grid, answer.result.grid) };
    const [shape] = await shapes(answer.id);
    const stages = stagesOf(document.grid, answer.steps, best, shape);
    update({ state: "done", best, shape, stages, answers: answersOf(document.grid, best, shape) });
  } catch (problem) {
    if (!(problem instanceof Problem)) throw problem;
    const steps = state.search?.key === key ? state.search.steps : [];
    if (steps.length < 2) return update({ state: "failed", problem });
    // What it had found by then is known here.
    const best = bestOf(document.grid, steps);
    update({ state: "done", problem, best, stages: stagesOf(document.grid, steps, best, null), answers: [] });
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
  const { materials } = search.document;
  return SHAPES.ask((signal) => simulate([stage.grid], { materials, signal }), (results) => {
    if (!results?.[0].ok) return;
    [stage.result] = results;
    if (state.search?.stages?.includes(stage) || state.search?.answers?.includes(stage)) show();
  });
}

/** Stop showing a stage. */
export function hideStage() {
  SHAPES.drop();
  endPreview("search");
}
