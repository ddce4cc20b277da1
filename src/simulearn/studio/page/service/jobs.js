// Jobs of the server: begun, asked about until they are finished, and cancelled.
//
// A lost connection does not end a job: the page asks again until the server answers. A server that
// was started anew knows the job no more; then it has failed, and its problem says so.

import { Problem, cancelJob, job as question } from "./api.js";

const SOON = 250; // ms between questions in the first seconds
const LATER = 1000; // ms after that
const SECONDS = 5; // s that are the first
const AGAIN = [1000, 2000, 4000]; // ms until the next try without a connection; the last one stays
const BUSY = 3; // times that a server too busy to begin a job is asked again
const MOST_STEPS = 1000; // in one answer of the server

const sleep = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });
const final = (state) => ["done", "failed", "cancelled"].includes(state);

/** Begin a job and follow it to its end.
 *
 * begin() asks the server for it. report({state, progress, steps, seconds, lost}) is called after each
 * answer; steps are all so far; lost: whether the server does not answer at the moment. wait(ms): pauses.
 * Returns {cancel, finished}: a promise of the last answer; it throws a Problem if the job failed.
 */
export function runJob(begin, report = () => {}, wait = sleep) {
  const wish = { cancel: false };
  return { cancel: () => { wish.cancel = true; }, finished: follow(begin, report, wish, wait) };
}

async function follow(begin, report, wish, wait) {
  const id = await begun(begin, wish, wait);
  if (id === null) return { state: "cancelled", steps: [], result: null };
  let steps = [];
  let last = { state: "queued", progress: null, seconds: 0 };
  let failures = 0;
  let cancelled = false;
  for (;;) {
    try {
      if (wish.cancel && !cancelled) {
        await cancelJob(id);
        cancelled = true;
      }
      const answer = await question(id, { since: steps.length });
      failures = 0;
      if (answer.steps.length) steps = [...steps, ...answer.steps];
      last = { ...answer, id, steps, lost: false };
      report(last);
      const complete = answer.steps.length < MOST_STEPS;
      if (final(answer.state) && complete) return finished(last);
      if (complete) await wait(answer.seconds < SECONDS ? SOON : LATER);
    } catch (problem) {
      if (!(problem instanceof Problem)) throw problem;
      const { status, message: detail } = problem;
      if (status === 404) throw new Problem({ status, code: "job-lost", detail });
      if (!problem.offline && status < 500 && status !== 429) throw problem;
      report({ ...last, id, steps, lost: true });
      await wait(AGAIN[Math.min(failures, AGAIN.length - 1)]);
      failures += 1;
    }
  }
}

/** Return the name of a new job, or null if it was cancelled before the server took it. */
async function begun(begin, wish, wait) {
  for (let tries = 0; ; tries += 1) {
    if (wish.cancel) return null;
    try {
      return (await begin()).job;
    } catch (problem) {
      if (problem.status !== 429 || tries === BUSY) throw problem;
      await wait(AGAIN[Math.min(tries, AGAIN.length - 1)]);
    }
  }
}

function finished(answer) {
  if (answer.state !== "failed") return answer;
  throw new Problem(answer.problem ?? { code: "failed" });
}
