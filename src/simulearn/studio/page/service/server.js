// What the page asks the server for once: what it is, its library, materials. Until it answers.

import { watchEffect, shallowRef } from "/libraries/vue.js";
import { state } from "../store.js";
import { library, materials, version } from "./api.js";

const PAUSE = 1000; // ms between questions to a server that does not answer yet

const known = shallowRef([]); // materials

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
  watchEffect(() => {
    state.material = known.value.find(({ name }) => name === state.document.grid.material) ?? null;
  });
  state.server = await untilAnswered(version);
  if (state.library.length === 0) await loadLibrary();
  known.value = (await untilAnswered(materials)).materials;
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
