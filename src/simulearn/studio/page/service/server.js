// What the page asks the server for once: what it is, and its library. Until it answers.

import { state } from "../store.js";
import { library, version } from "./api.js";

const PAUSE = 1000; // ms between questions to a server that does not answer yet

/** Return the answer to a question, put again until the server answers it. */
export async function untilAnswered(question) {
  for (;;) {
    try {
      const answer = await question();
      state.connection = "online";
      return answer;
    } catch (problem) {
      if (!problem.offline && problem.status < 500) throw problem;
      state.connection = "offline";
      await pause(PAUSE);
    }
  }
}

/** Fetch what the panels show of the server, and wait until its model is ready. */
export async function startServer() {
  state.server = await untilAnswered(version);
  if (state.library.length === 0) await loadLibrary();
  while (!state.server.ready) {
    await pause(PAUSE);
    state.server = await untilAnswered(version);
  }
}

/** Return the designs of the library. */
export async function loadLibrary() {
  if (state.library.length === 0) state.library = (await untilAnswered(library)).designs;
  return state.library;
}

const pause = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });
