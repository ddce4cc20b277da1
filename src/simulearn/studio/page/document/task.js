// The task of a search: the grid, the goals, what may change, and when to stop.

/** Return the task of a document, as POST /api/optimize and /api/rank take it.
 *
 * free, limits, method and engine are left out where they are not given: the server's are used.
 */
export function taskOf(document, { free, limits, method, engine = "learned" } = {}) {
  const materials = document.materials.length ? document.materials : undefined;
  const pose = document.pose === "free" ? "free" : undefined;
  const task = {
    schema: "simulearn.task/1", grid: document.grid, goals: goalsOf(document), pose, free, method, engine,
    limits, materials,
  };
  return Object.fromEntries(Object.entries(task).filter(([, value]) => value !== undefined));
}

/** Return a document as a task file, which `simulearn optimize` takes: its surfaces are in it. */
export function taskFile(document) {
  const { materials, ...task } = taskOf(document);
  return task;
}

/** Return the goals of a document with their surfaces in place of the surfaces' names. */
function goalsOf({ goals, surfaces }) {
  const meshes = new Map(surfaces.map(({ name, vertices, faces }) => [name, { vertices, faces }]));
  return goals.map((goal) => {
    const next = { ...goal };
    for (const key of ["surface", "away_from"]) if (meshes.has(goal[key])) next[key] = meshes.get(goal[key]);
    return next;
  });
}
