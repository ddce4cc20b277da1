// The task of a search: the grid, the goals, what may change, and when to stop.

/** Return the task of a document, as POST /api/optimize and /api/rank take it.
 *
 * free, limits, method and engine are left out where they are not given: the server's are used.
 */
export function taskOf(document, { free, limits, method, engine = "learned" } = {}) {
  const goals = document.goals.map(({ vertex, target, weight }) => ({ vertex, target, weight }));
  const materials = document.materials.length ? document.materials : undefined;
  const task = {
    schema: "simulearn.task/1", grid: document.grid, goals, free, method, engine, limits, materials,
  };
  return Object.fromEntries(Object.entries(task).filter(([, value]) => value !== undefined));
}
