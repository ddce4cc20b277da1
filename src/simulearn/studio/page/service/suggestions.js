// Suggestions: the single changes of the design that bring it closest to its goals, each with its shape.
// state.suggestions has
//   document: that they are for, state: "asking", "ready" or "failed", problem: why it failed,
//   error: mean distance of the design itself, mm,
//   cards: {grid, error, result, picture, changes} the best first.

import { sameWishes } from "../document/kinds.js";
import { taskOf } from "../document/task.js";
import { thumbnail } from "../shape/thumbnail.js";
import { state } from "../store.js";
import { rank, simulate } from "./api.js";
import { changesOf, placedLike } from "./designs.js";
import { latest } from "./latest.js";

const QUIET = 250; // ms without a change until suggestions are asked for
const AGAIN = 3000; // ms until a server that was busy or away is asked again
const PICTURE = { width: 176, height: 112 }; // pixels, twice what is shown

const questions = latest(QUIET);
const retries = latest(AGAIN);

/** Return whether the suggestions are those of the current design and goals. */
export function freshSuggestions() {
  const of = state.suggestions?.document;
  return Boolean(of) && of.grid === state.document.grid && sameWishes(of, state.document);
}

/** Ask for suggestions for the current document, if it has goals and a shape. */
export function askSuggestions() {
  retries.drop();
  const { document, answer } = state;
  if (document.goals.length === 0 || document.grid.beams.length === 0) {
    questions.drop();
    state.suggestions = null;
    return;
  }
  // Until the design is simulated nothing is known of it; its answer leads back here.
  if (answer?.document.grid !== document.grid) return questions.drop();
  if (freshSuggestions() && state.suggestions.state === "ready") return;
  questions.ask((signal) => suggest(document, signal), (ready, problem) => {
    if (ready) {
      state.suggestions = ready;
      drawSuggestions();
      return;
    }
    state.suggestions = { document, state: "failed", problem, cards: [] };
    if (problem.offline || problem.status === 429 || problem.status >= 500)
      retries.ask(async () => null, askSuggestions);
  });
}

/** Give up what is being asked. */
export function dropSuggestions() {
  questions.drop();
  retries.drop();
}

async function suggest(document, signal) {
  const ranking = await rank(taskOf(document), signal);
  const found = ranking.best.map(({ grid, error_mm: error }) => ({
    grid: placedLike(document.grid, grid), error, result: null, picture: null,
  }));
  const { materials } = document;
  const results = found.length ? await simulate(found.map(({ grid }) => grid), { materials, signal }) : [];
  const cards = found.map((card, k) => ({
    ...card, result: results[k], changes: changesOf(document.grid, card.grid),
  })).filter(({ result }) => result.ok);
  return { document, state: "ready", error: ranking.error_mm, cards };
}

/** Draw the pictures, one after the other; those of suggestions that are gone are left out. */
export async function drawSuggestions() {
  const { cards } = state.suggestions ?? { cards: [] };
  for (const card of cards) {
    const picture = await thumbnail(card.result, PICTURE);
    if (state.suggestions?.cards !== cards) return;
    card.picture = picture;
    state.suggestions = { ...state.suggestions };
  }
}
