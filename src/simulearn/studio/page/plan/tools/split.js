// The tool Split: a click on a beam puts a joint there; at the middle and level with others it snaps.

import { splitBeam } from "../../document/drawing.js";
import { beamLength, between, nearestBeam } from "../../document/measure.js";
import { snap } from "../../document/snapping.js";
import { edit, select, state } from "../../store.js";
import { t } from "../../text/text.js";
import { announce, beamWidth, clearMarks, editor, reach } from "../editor.js";

export const split = {
  hover(pointer) {
    editor.cut = cutAt(pointer);
    state.hover = editor.cut ? { beam: editor.cut.beam } : null;
  },

  press: (pointer) => split.hover(pointer),
  drag: (pointer) => split.hover(pointer),

  release(pointer) {
    split.hover(pointer);
    const { cut } = editor;
    split.cancel();
    if (!cut) return;
    edit((document) => splitBeam(document, cut.beam, cut.t), { label: t("plan.editSplit") });
    select({ joints: [state.document.grid.joints.length - 1] });
    announce(t("plan.saidSplit", { beam: cut.beam }));
  },

  leave() {
    split.cancel();
    state.hover = null;
  },

  key({ key }) {
    if (key !== "Escape") return false;
    state.tool = "select";
    return true;
  },

  cancel: clearMarks,
};

/** Return where a click would split a beam: {beam, t, point, lengths}, or null. */
function cutAt({ point, touch, alt }) {
  const { document } = state;
  const { grid } = document;
  const near = nearestBeam(grid, point);
  const radius = Math.max(reach(touch), beamWidth() / 2);
  if (!near || near.distance > radius) return null;
  const found = alt ? null : snap(near.point, { document, grid: 0, radius: reach(touch) / 2, angle: 0 });
  const length = beamLength(grid, near.number);
  let t = found?.beam === near.number ? found.t : near.t;
  if (!alt) {
    // Free places fall on whole mm from the beam's start.
    const middle = Math.abs(t - 0.5) < 1e-6;
    if (!middle && found?.kind !== "crossing") t = Math.round(t * length) / length;
  }
  if (!(t > 0 && t < 1)) return null;
  const [p, q] = grid.beams[near.number].map((k) => grid.joints[k]);
  return { beam: near.number, t, point: between(p, q, t), lengths: [t * length, (1 - t) * length] };
}
