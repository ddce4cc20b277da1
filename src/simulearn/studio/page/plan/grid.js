// The drawing grid behind the plan, the axes' mark at the fixed joint, and the scale bar.

import { h } from "/libraries/vue.js";
import { toScreen } from "./camera.js";
import { editor } from "./editor.js";
import { gridLines, scaleBar } from "./gridlines.js";
import { state } from "../store.js";

const AXIS = 44; // px, length of the arrows at the origin

export const Grid = {
  render() {
    const { minor, major } = gridLines(editor.camera, editor.size);
    return h("g", { class: "plan-grid", "aria-hidden": "true" }, [
      h("path", { class: "minor", d: minor }),
      h("path", { class: "major", d: major }),
      axes(),
    ]);
  },
};

/** x and y at the fixed joint, which is the origin of results. */
function axes() {
  const { joints, fixed } = state.document.grid;
  const [x, y] = toScreen(editor.camera, joints[fixed] ?? [0, 0]).map((value) => Math.round(value) + 0.5);
  return h("g", { class: "axes", transform: `translate(${x} ${y})` }, [
    h("path", { class: "x", d: `M0 0H${AXIS}m-5 -3.5l5 3.5l-5 3.5` }),
    h("path", { class: "y", d: `M0 0V${-AXIS}m-3.5 5l3.5 -5l3.5 5` }),
    h("text", { class: "x", x: AXIS + 5, y: 4 }, "x"),
    h("text", { class: "y", x: -3, y: -AXIS - 6 }, "y"),
  ]);
}

/** A bar of a round length. */
export const ScaleBar = {
  render() {
    const { mm, px } = scaleBar(editor.camera.scale);
    return h("div", { class: "plan-scale", "aria-hidden": "true" }, [
      h("span", `${mm} mm`),
      h("i", { style: { width: `${px}px` } }),
    ]);
  },
};
