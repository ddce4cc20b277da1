// Marks on parts: badges of errors and warnings, and lengths and heights where they are switched on.

import { h } from "/libraries/vue.js";
import { beamLength, beamsAt } from "../document/measure.js";
import { state, view } from "../store.js";
import { beamWidth } from "./editor.js";
import { placeOf } from "./focus.js";
import { jointHeight, shown } from "./lengths.js";
import { marksOf } from "./messages.js";

export const Marks = {
  render() {
    const { grid } = state.document;
    const marks = marksOf(state.check, grid);
    return h("g", { class: "plan-marks", "aria-hidden": "true" }, [
      view.dimensions ? h("g", { class: "dimensions" }, grid.beams.map((_, b) => dimension(grid, b))) : null,
      view.heights ? h("g", { class: "heights" }, grid.joints.map((_, k) => height(grid, k))) : null,
      ...[...marks.beams].map(([beam, mark]) => badge(grid, { beam }, mark)),
      ...[...marks.joints].map(([joint, mark]) => badge(grid, { joint }, mark)),
    ]);
  },
};

/** A length beside its beam, above it where it is level. */
function dimension(grid, b) {
  const [p, q] = grid.beams[b].map((k) => grid.joints[k]);
  const [x, y] = placeOf(grid, { beam: b });
  let turn = (Math.atan2(q[1] - p[1], q[0] - p[0]) * 180) / Math.PI;
  if (turn > 90.01 || turn <= -89.99) turn += 180;
  const transform = `translate(${x} ${y}) rotate(${turn}) translate(0 ${beamWidth() / 2}) scale(1 -1)`;
  return h("g", { key: b, transform },
    h("text", { class: "sized", y: -5 }, shown(beamLength(grid, b))));
}

/** A joint's height in the last frame, beside it where no beam leads. */
function height(grid, k) {
  const z = jointHeight(state.answer, grid, k);
  if (z === null) return null;
  const [x, y] = grid.joints[k];
  const steep = beamsAt(grid, k).some((b) => {
    const other = grid.joints[grid.beams[b].find((n) => n !== k)];
    return other[0] >= x && other[1] >= y;
  });
  const side = steep ? -1 : 1;
  return h("g", { key: k, transform: `translate(${x} ${y})` },
    h("g", { class: "upright" },
      h("text", { class: side < 0 ? "left" : "right", x: 11 * side, y: -10 }, `z ${shown(z)}`)));
}

function badge(grid, part, { kind }) {
  const place = placeOf(grid, part);
  if (!place) return null;
  const [dx, dy] = part.joint !== undefined ? [11, -11] : [0, -16];
  return h("g", { class: ["badge", kind], key: JSON.stringify(part), transform: `translate(${place})` },
    h("g", { class: "upright" }, [
      kind === "error"
        ? h("circle", { cx: dx, cy: dy, r: 8 })
        : h("path", { class: "sign", d: `M${dx} ${dy - 9}l9.5 16.5h-19z` }),
      h("text", { x: dx, y: dy + (kind === "error" ? 4.2 : 5) }, "!"),
    ]));
}
