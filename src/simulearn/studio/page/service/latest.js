// Questions of which only the last one counts.

/** Return {ask, drop}: ask(question, accept) puts question(signal) after a pause.
 *
 * A later one, or drop(), gives an earlier one up: its answer is not accepted. accept(answer, problem)
 * has either.
 */
export function latest(pause) {
  let timer = 0;
  let control = null;
  const drop = () => {
    clearTimeout(timer);
    control?.abort();
    control = null;
  };
  const ask = (question, accept) => {
    drop();
    const mine = new AbortController();
    control = mine;
    timer = setTimeout(async () => {
      let [answer, problem] = [null, null];
      try {
        answer = await question(mine.signal);
      } catch (error) {
        problem = error;
      }
      if (control === mine && !mine.signal.aborted) accept(answer, problem);
    }, pause);
  };
  return { ask, drop };
}
