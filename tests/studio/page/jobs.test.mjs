// Jobs of the server: steps that come in parts, lost connections, restarts, cancelling.

import assert from "node:assert/strict";
import { afterEach, test } from "node:test";
import { runJob } from "../../../src/simulearn/studio/page/service/jobs.js";
import { Problem } from "../../../src/simulearn/studio/page/service/api.js";

const REAL = globalThis.fetch;
const pauses = [];
const wait = async (ms) => { pauses.push(ms); };
const begin = async () => ({ job: "one" });
const running = (steps = [], more = {}) => ({
  job: "one", state: "running", progress: null, seconds: 1, steps, result: null, problem: null, ...more,
});
const done = (steps = []) => running(steps, { state: "done", result: { grid: 1 } });

afterEach(() => {
  globalThis.fetch = REAL;
  pauses.length = 0;
});

/** Have the server give these answers, one after the other; null: it is not reached, a number: a status. */
function serve(answers) {
  const requests = [];
  globalThis.fetch = async (path, { method }) => {
    requests.push(`${method} ${path}`);
    const answer = answers.shift();
    if (answer === undefined) throw new Error("the page asks once too often");
    if (answer === null) throw new TypeError("failed to fetch");
    const status = typeof answer === "number" ? answer : 200;
    const body = status === 200 ? answer : { detail: "no such job", code: "job-unknown" };
    return { ok: status === 200, status, json: async () => body };
  };
  return requests;
}

test("steps come in parts and are put together", async () => {
  const requests = serve([running([1, 2]), running(), running([3]), done()]);
  const reports = [];
  const answer = await runJob(begin, (report) => reports.push(report.steps.length), wait).finished;
  assert.deepEqual(answer.steps, [1, 2, 3]);
  assert.deepEqual(answer.result, { grid: 1 });
  assert.deepEqual(reports, [2, 2, 3, 3]);
  assert.deepEqual(requests, [0, 2, 2, 3].map((n) => `GET /api/jobs/one?since=${n}`));
});

test("a full answer is followed by the next one at once, even if the job is done", async () => {
  const full = Array.from({ length: 1000 }, (_, n) => n);
  serve([done(full), done([1000])]);
  const answer = await runJob(begin, undefined, wait).finished;
  assert.equal(answer.steps.length, 1001);
  assert.deepEqual(pauses, []);
});

test("a lost connection is reported, and the job goes on when it is back", async () => {
  serve([running([1]), null, null, null, null, running([2]), done()]);
  const lost = [];
  const answer = await runJob(begin, (report) => lost.push(report.lost), wait).finished;
  assert.equal(answer.state, "done");
  assert.deepEqual(lost, [false, true, true, true, true, false, false]);
  assert.deepEqual(pauses.slice(1, 5), [1000, 2000, 4000, 4000]);
});

test("a server that was started anew has lost the job", async () => {
  serve([running([1]), null, 404]);
  await assert.rejects(runJob(begin, undefined, wait).finished, { code: "job-lost" });
});

test("a failed job throws its problem", async () => {
  const problem = { code: "no-answer", detail: "the engine has no answer", status: 422 };
  serve([running([], { state: "failed", problem })]);
  await assert.rejects(runJob(begin, undefined, wait).finished, (error) => (
    error instanceof Problem && error.code === "no-answer" && error.message === "the engine has no answer"
  ));
});

test("a cancelled job is asked for its result, also without a connection for a while", async () => {
  const end = running([2], { state: "cancelled", result: { grid: 2 } });
  const requests = serve([running([1]), null, running([1]), end]);
  const job = runJob(begin, (report) => { if (report.steps.length === 1) job.cancel(); }, wait);
  const answer = await job.finished;
  assert.deepEqual(answer.result, { grid: 2 });
  assert.deepEqual(requests.map((line) => line.split(" ")[0]), ["GET", "DELETE", "DELETE", "GET"]);
});

test("a busy server is asked a few times to begin", async () => {
  const busy = (times) => {
    let tries = 0;
    return async () => {
      tries += 1;
      if (tries <= times) throw new Problem({ status: 429, detail: "too many jobs" });
      return { job: "one" };
    };
  };
  serve([done()]);
  assert.equal((await runJob(busy(2), undefined, wait).finished).state, "done");
  await assert.rejects(runJob(busy(9), undefined, wait).finished, { status: 429 });
});

test("a job that is cancelled before the server takes it never begins", async () => {
  serve([]);
  const busy = async () => { throw new Problem({ status: 429 }); };
  const job = runJob(busy, undefined, async () => job.cancel());
  assert.equal((await job.finished).state, "cancelled");
});
