// The curve of a search: the best error over the designs that were tried.

import { h } from "/libraries/vue.js";
import { mm, number } from "../service/format.js";
import { bestSoFar, roundUp } from "../service/steps.js";
import { t } from "../text/text.js";

const SIZE = { width: 300, height: 120 }; // units of the picture, about pixels
const EDGE = { left: 34, right: 10, top: 12, bottom: 22 };

/** Return the curve of a search's steps. at: a number of designs to mark with a point, or null. */
export function curve(steps, at = null) {
  const { points, corrections } = bestSoFar(steps);
  if (points.length === 0) return null;
  const most = roundUp(Math.max(...points.map(([, error]) => error)));
  const designs = Math.max(1, points.at(-1)[0]);
  const x = (value) => EDGE.left + (value / designs) * (SIZE.width - EDGE.left - EDGE.right);
  const y = (value) => SIZE.height - EDGE.bottom - (value / most) * (SIZE.height - EDGE.top - EDGE.bottom);
  const corner = ([n, error]) => `${x(n).toFixed(1)} ${y(error).toFixed(1)}`;
  const digits = most < 1 ? 2 : most < 10 ? 1 : 0;
  const line = (value) => [
    h("line", {
      class: "curve-line", x1: EDGE.left, x2: SIZE.width - EDGE.right, y1: y(value), y2: y(value),
    }),
    h("text", {
      class: "curve-number", x: EDGE.left - 6, y: y(value) + 4, "text-anchor": "end",
    }, number(value, digits)),
  ];
  const marked = at === null ? points.at(-1) : points.findLast(([n]) => n <= at) ?? points[0];
  return h("svg", {
    class: "curve", viewBox: `0 0 ${SIZE.width} ${SIZE.height}`, role: "img",
    "aria-label": t("panels.curve", { first: mm(points[0][1]), last: mm(points.at(-1)[1]) }),
  }, [
    ...line(0), ...line(most / 2), ...line(most),
    h("text", { class: "curve-unit", x: EDGE.left + 4, y: EDGE.top + 12 }, t("panels.axisMm")),
    h("text", { class: "curve-number", x: EDGE.left, y: SIZE.height - 5 }, "0"),
    h("text", { class: "curve-number", x: SIZE.width - EDGE.right, y: SIZE.height - 5, "text-anchor": "end" },
      `${number(designs)} ${t("panels.axisDesigns")}`),
    ...corrections.map((n) => h("line", {
      class: "curve-correction", x1: x(n), x2: x(n), y1: EDGE.top, y2: SIZE.height - EDGE.bottom,
    }, [h("title", t("panels.correction"))])),
    h("path", { class: "curve-path", d: `M${points.map(corner).join("L")}` }),
    h("circle", { class: "curve-mark", cx: x(at === null ? marked[0] : at), cy: y(marked[1]), r: 3.5 }),
  ]);
}
