// Surfaces that people drop on the page: each becomes a goal of the design, that all joints lie on it.
// What is told of a file, and the file itself, stay in the page's memory.

import { ref } from "/libraries/vue.js";
import { addSurface, boxOf, hasRoom, withSurface } from "../document/surfaces.js";
import { edit, notify, state, undo, view } from "../store.js";
import { t } from "../text/text.js";

const known = new WeakMap(); // vertices -> { file, options, facts }
const changes = ref(0); // in `known`

/** Return what is told of a surface { vertices }: { file, options, facts }, or null after a reload. */
export function fileOf({ vertices }) {
  return changes.value >= 0 ? known.get(vertices) ?? null : null; // asks for `changes`, which is watched
}

/** Make a surface that was read from a file a goal of the design; `replaces` is the name of one that is
 * read again. */
export function takeSurface(file, options, { name, surface }, replaces = null) {
  known.set(surface.vertices, { file, options, facts: surface });
  changes.value += 1;
  if (replaces !== null) {
    edit((document) => withSurface(document, replaces, surface), {
      label: t("surface.didUnit", { name: replaces, unit: surface.unit }),
    });
    return;
  }
  if (!hasRoom(state.document)) {
    state.dialog = { name: "message", title: t("common.openFailed", { file: file.name }), text: t("surface.many") };
    return;
  }
  const free = state.document.goals.length === 0 && apart(surface.vertices);
  edit((document) => addSurface(document, name, surface, free ? "free" : null), {
    label: t("surface.did", { name }),
  });
  Object.assign(state, { tab: "goals" });
  view.side = true;
  notify(t(free ? "surface.openedFree" : "surface.opened", { name }), { label: t("common.undoWord"), run: undo });
}

/** Return whether a surface lies elsewhere than the grid: beside it, or farther above or below than its size. */
function apart(vertices) {
  const { joints, fixed } = state.document.grid;
  if (joints.length === 0) return false;
  const [x, y] = joints[fixed];
  const grid = boxOf(joints.map(([u, v]) => [u - x, v - y, 0]));
  const size = Math.hypot(grid.high[0] - grid.low[0], grid.high[1] - grid.low[1]);
  grid.low[2] -= size;
  grid.high[2] += size;
  const { low, high } = boxOf(vertices);
  return [0, 1, 2].some((axis) => low[axis] > grid.high[axis] || high[axis] < grid.low[axis]);
}

/** Show places of a surface in the scene; null: none. */
export function showPlaces(points) {
  state.spots = points;
}
