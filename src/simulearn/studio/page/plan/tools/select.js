// The tool Select: click, drag a box, drag joints and beams. A drag edits the document in each frame,
// so that the shape follows; its end joins what now meets.

import { settle } from "../../document/drawing.js";
import { jointsOf, moveJoints } from "../../document/edit.js";
import { beamsAt } from "../../document/measure.js";
import { snap } from "../../document/snapping.js";
import { edit, endMerge, load, select, state } from "../../store.js";
import { t } from "../../text/text.js";
import { announce, beamWidth, clearMarks, editor, focusPart, reach, snapStep } from "../editor.js";
import { minus } from "../geometry.js";
import { isSelected, only, partAt, partsInBox, toggled } from "../hit.js";

const JOIN = 1; // mm; a joint dropped nearer to another or to a beam joins it

let gesture = null; // { kind: "part" | "box" | "move", ... } while a button is down
let count = 0; // of drags, so that each has its own key in the history

export const selectTool = {
  hover(pointer) {
    state.hover = partUnder(pointer);
  },

  press(pointer) {
    const part = partUnder(pointer);
    const { selection } = state;
    if (!part) {
      const kept = pointer.shift ? selection : { joints: [], beams: [] };
      gesture = { kind: "box", start: pointer.point, before: selection, selection: kept };
      return;
    }
    const already = isSelected(selection, part);
    if (pointer.shift) select(toggled(selection, part));
    else if (!already) select(only(part));
    gesture = { kind: "part", part, already, start: pointer.point };
    editor.popover = null;
    focusPart(part);
  },

  drag(pointer) {
    if (gesture?.kind === "part") beginMove(gesture);
    if (gesture?.kind === "move") move(gesture, pointer);
    if (gesture?.kind === "box") box(gesture, pointer);
  },

  release(pointer) {
    const ended = gesture;
    gesture = null;
    if (ended?.kind === "move") drop(ended);
    if (ended?.kind === "part") click(ended, pointer);
    if (ended?.kind === "box" && !editor.box && !pointer.shift) select({});
    clearMarks();
  },

  leave() {
    if (state.hover?.goal === undefined) state.hover = null;
  },

  key({ key }) {
    if (key !== "Escape") return false;
    if (gesture) {
      selectTool.cancel();
      return true;
    }
    if (editor.popover) {
      editor.popover = null;
      return true;
    }
    const { joints, beams } = state.selection;
    if (joints.length + beams.length === 0) return false;
    select({});
    return true;
  },

  /** Take back what the drag in progress did. */
  cancel() {
    const ended = gesture;
    gesture = null;
    clearMarks();
    if (ended?.kind === "move" && state.document === ended.document) load(ended.before, ended.history);
    if (ended?.kind === "box") select(ended.before);
  },
};

function partUnder({ point, touch }) {
  return partAt(state.document.grid, point, reach(touch), beamWidth());
}

function click({ part, already }, pointer) {
  if (already && !pointer.shift) select(only(part));
  if (part.beam !== undefined && !pointer.shift) editor.popover = { beam: part.beam };
  else if (part.joint !== undefined) editor.popover = null;
}

/** Begin to move what is selected. */
function beginMove(from) {
  const { document, selection } = state;
  const { grid } = document;
  const { part, start } = from;
  const moving = jointsOf(grid, isSelected(selection, part) ? selection : only(part));
  // The joint that snaps: the one that is held, or the end of the beam that is nearer.
  const candidates = part.joint !== undefined ? [part.joint] : grid.beams[part.beam];
  const away = (k) => Math.hypot(grid.joints[k][0] - start[0], grid.joints[k][1] - start[1]);
  const lead = candidates.reduce((best, k) => (away(k) < away(best) ? k : best));
  const beams = moving.length === 1 ? beamsAt(grid, lead) : [];
  const neighbour = beams.length === 1 ? grid.beams[beams[0]].find((k) => k !== lead) : null;
  gesture = {
    kind: "move", moving, lead, start, before: document, document, history: state.history,
    from: neighbour === null ? null : grid.joints[neighbour], key: `plan-drag-${(count += 1)}`,
  };
  editor.dragging = true;
  state.hover = part;
}

function move(drag, pointer) {
  // Somebody else has replaced the document meanwhile: the drag has nothing left to move.
  if (state.document !== drag.document) return selectTool.cancel();
  const { before, lead, moving } = drag;
  const origin = before.grid.joints[lead];
  const [dx, dy] = minus(pointer.point, drag.start);
  const wanted = [origin[0] + dx, origin[1] + dy];
  const found = pointer.alt
    ? { point: wanted, kind: "none", guides: [] }
    : snap(wanted, {
      document: before, exclude: moving, from: drag.from, grid: snapStep(),
      radius: Math.min(reach(pointer.touch), beamWidth()),
    });
  editor.snapped = found;
  const by = minus(found.point, origin);
  edit(() => moveJoints(before, moving, by), { label: moveLabel(moving), merge: drag.key });
  drag.document = state.document;
}

/** End a move: joints that lie on others or on beams are joined. */
function drop({ moving, document, before, history, key }) {
  if (state.document !== document) return;
  if (document === before) {
    load(before, history);
    return;
  }
  const { grid } = document;
  edit((moved) => settle(moved, moving, JOIN), { label: moveLabel(moving), merge: key });
  endMerge();
  const after = state.document.grid;
  if (after.joints.length !== grid.joints.length || after.beams.length !== grid.beams.length) {
    select({});
    announce(t("plan.saidJoined", { joints: after.joints.length, beams: after.beams.length }));
  } else announce(t("plan.saidMoved", { count: moving.length }));
}

function moveLabel(moving) {
  return moving.length === 1 ? t("plan.editMoveJoint") : t("plan.editMoveJoints");
}

function box(from, pointer) {
  editor.box = [from.start, pointer.point];
  const inside = partsInBox(state.document.grid, editor.box);
  const { joints, beams } = from.selection;
  const union = (a, b) => [...new Set([...a, ...b])];
  select({ joints: union(joints, inside.joints), beams: union(beams, inside.beams) });
}
