// What changes with every movement of the pointer, in a layer of its own: hover, the line being
// drawn, guides, the selection box, the place of a split.

import { h } from "/libraries/vue.js";
import { state } from "../store.js";
import { beamWidth, editor } from "./editor.js";

/** What lies below the parts: the halo of the hovered one. */
export const Under = {
  render() {
    const { grid } = state.document;
    const part = state.hover;
    const width = beamWidth();
    if (part?.beam !== undefined && grid.beams[part.beam]) {
      const [p, q] = grid.beams[part.beam].map((k) => grid.joints[k]);
      return halo(h("path", { d: `M${p}L${q}`, style: { "--wide": width } }));
    }
    if (part?.joint !== undefined && grid.joints[part.joint]) {
      const [x, y] = grid.joints[part.joint];
      return halo(h("circle", { cx: x, cy: y }));
    }
    return h("g");
  },
};

const halo = (mark) => h("g", { class: "plan-hover", "aria-hidden": "true" }, mark);

/** What lies above the parts. */
export const Over = {
  render() {
    const { line, snapped, box, cut } = editor;
    const active = line || editor.dragging;
    return h("g", { class: "plan-over", "aria-hidden": "true" }, [
      active ? guides(snapped) : null,
      line ? drawn(line) : null,
      active && snapped ? snapMark(snapped) : null,
      cut ? h("circle", { class: "handle cut", cx: cut.point[0], cy: cut.point[1] }) : null,
      box ? selectionBox(box) : null,
    ]);
  },
};

/** The places that a panel speaks of. */
export const Places = {
  render() {
    const { points = [], current = null } = state.places ?? {};
    return h("g", { class: "plan-places", "aria-hidden": "true" }, points.map(([x, y], k) =>
      h("circle", { key: k, class: { current: k === current }, cx: x, cy: y })));
  },
};

function guides(snapped) {
  return (snapped?.guides ?? []).map(([p, q], k) => h("path", { key: k, class: "guide", d: `M${p}L${q}` }));
}

/** The line at the beams' true width, its corners placed and the joints that it will add. */
function drawn({ points, fixed, joints }) {
  const d = (list) => (list.length > 1 ? `M${list.map((p) => p.join(" ")).join("L")}` : "");
  return h("g", { class: "line" }, [
    h("path", { class: "body", d: d(points), "stroke-width": beamWidth() }),
    h("path", { class: "axis", d: d(points) }),
    ...joints.map(([x, y], k) => h("circle", { key: k, class: "handle", cx: x, cy: y })),
    ...points.slice(0, fixed).map(([x, y], k) =>
      h("circle", { key: `p${k}`, class: "handle placed", cx: x, cy: y })),
  ]);
}

function snapMark({ point, kind }) {
  const free = kind === "grid" || kind === "none";
  return h("circle", { class: ["snap", { free }], cx: point[0], cy: point[1] });
}

function selectionBox([p, q]) {
  return h("rect", {
    class: "box", x: Math.min(p[0], q[0]), y: Math.min(p[1], q[1]),
    width: Math.abs(p[0] - q[0]), height: Math.abs(p[1] - q[1]),
  });
}
