// Beams and joints of the plan as SVG, in mm. Each is a component whose properties are plain values,
// so that an edit draws only what it changed.

import { h } from "/libraries/vue.js";
import { beamAngle, beamLength } from "../document/measure.js";
import { state, view } from "../store.js";
import { t } from "../text/text.js";
import { ratioText } from "./actions.js";
import { beamWidth, editor } from "./editor.js";
import { tabStop } from "./focus.js";
import { jointHeight, netLengths, shown } from "./lengths.js";
import { marksOf } from "./messages.js";

const LABEL = 17; // mm; shorter actuators carry no text

/** All joints and beams of the document. */
export const Parts = {
  render() {
    const { document, selection, check } = state;
    const { grid } = document;
    const width = beamWidth();
    const net = netLengths(grid, check, width);
    const marks = marksOf(check, grid);
    const stop = tabStop(grid, editor.focus);
    const chosen = { joints: new Set(selection.joints), beams: new Set(selection.beams) };
    const { language } = view;
    return h("g", { class: "plan-parts" }, [
      h("g", { role: "presentation" }, grid.beams.map(([i, j], b) =>
        h(Beam, {
          key: b, b, width, language, x1: grid.joints[i][0], y1: grid.joints[i][1],
          x2: grid.joints[j][0], y2: grid.joints[j][1], ratio: grid.actuators[b], net: net[b],
          selected: chosen.beams.has(b), stop: stop?.beam === b, mark: marks.beams.get(b)?.kind ?? "",
          message: marks.beams.get(b)?.messages.join(" ") ?? "",
        }))),
      h("g", { role: "presentation" }, grid.joints.map(([x, y], k) =>
        h(Joint, {
          key: k, k, x, y, width, language, fixed: grid.fixed === k, selected: chosen.joints.has(k),
          stop: stop?.joint === k, mark: marks.joints.get(k)?.kind ?? "",
          message: marks.joints.get(k)?.messages.join(" ") ?? "",
        }))),
    ]);
  },
};

const Beam = {
  props: [
    "b", "x1", "y1", "x2", "y2", "ratio", "net", "width", "selected", "stop", "mark", "message", "language",
  ],
  render() {
    const { b, x1, y1, x2, y2, ratio, net, width, selected, stop, mark } = this;
    const length = Math.hypot(x2 - x1, y2 - y1);
    const turn = (Math.atan2(y2 - y1, x2 - x1) * 180) / Math.PI;
    const active = Math.abs(ratio) * Math.min(net, length);
    const half = ratio > 0 ? "top" : "bottom";
    const box = (long, high) => ({ x: -long / 2, y: -high / 2, width: long, height: high });
    return h("g", {
      class: ["beam", mark, { selected }], role: "option", "aria-selected": selected,
      "aria-label": beamLabel(this), tabindex: stop ? 0 : -1, "data-beam": b,
      transform: `translate(${(x1 + x2) / 2} ${(y1 + y2) / 2}) rotate(${turn})`,
    }, [
      h("rect", { class: "body", ...box(length, width) }),
      ratio === 0 ? null : h("rect", { class: ["active", half], ...box(active, width) }),
      ratio === 0 ? null : h("path", {
        class: ["pattern", half], d: pattern(half, active, width),
        "stroke-width": half === "top" ? width : width / 6.5,
      }),
      h("rect", { class: "edge", ...box(length, width) }),
      ratio === 0 || Math.min(net, length) < LABEL ? null : ratioMark(ratio, turn),
    ]);
  },
};

/** What tells top from bottom where colours do not: bars across for top, two rows of dots for bottom.
 *
 * Dashed lines (see the style sheet), since filling with an SVG pattern takes twice the time.
 */
function pattern(half, active, width) {
  const [from, to] = [-active / 2 + 1, active / 2 - 1];
  if (half === "top") return `M${from} 0H${to}`;
  return `M${from} ${width / 5}H${to}M${from} ${-width / 5}H${to}`;
}

/** The ratio as a small plate in the middle of a beam, readable from below or from the right. */
function ratioMark(ratio, turn) {
  const upside = turn > 90.01 || turn <= -89.99;
  const text = `${shown(Math.abs(ratio) * 100, 0)} %`;
  const wide = 18 + text.length * 6.4; // px, with the arrow
  const transform = upside ? "scale(-1 1)" : "scale(1 -1)";
  return h("g", { class: ["ratio", ratio > 0 ? "top" : "bottom"], transform }, [
    h("g", { class: "sized" }, [
      h("rect", { x: -wide / 2, y: -7.5, width: wide, height: 15, rx: 4 }),
      h("path", {
        d: ratio > 0 ? "M0 -3.5l3.6 6h-7.2z" : "M0 3.5l3.6 -6h-7.2z",
        transform: `translate(${9.5 - wide / 2} 0.3)`,
      }),
      h("text", { x: 5.5, y: 3.8 }, text),
    ]),
  ]);
}

const Joint = {
  props: ["k", "x", "y", "width", "fixed", "selected", "stop", "mark", "message", "language"],
  render() {
    const { k, x, y, width, fixed, selected, stop, mark } = this;
    return h("g", {
      class: ["joint", mark, { selected, fixed }], role: "option", "aria-selected": selected,
      "aria-label": jointLabel(this), tabindex: stop ? 0 : -1, "data-joint": k,
      transform: `translate(${x} ${y})`,
    }, [
      h("circle", { class: "body", r: width / 2 }),
      h("circle", { class: "handle" }),
      fixed ? h("g", { class: "upright pin" }, h("path", { d: PIN })) : null,
    ]);
  },
};

// An anchor on 16 by 16 around the origin.
const PIN = "M0 -2.4V5.6M-2.7 -.4H2.7M-5 2C-4.7 4.4 -2.8 5.6 0 5.6C2.8 5.6 4.7 4.4 5 2"
  + "M0 -5.4a1.5 1.5 0 1 0 .01 0z";

/** Return a beam's name for screen readers: "Beam 7, 65.0 mm, actuator 50 % top". */
function beamLabel({ b, x1, y1, x2, y2, ratio, selected, mark, message }) {
  return [
    t("plan.beam", { beam: b }), `${shown(Math.hypot(x2 - x1, y2 - y1))} mm`,
    ratio === 0 ? t("plan.noActuator") : t("plan.actuatorLabel", { ratio: ratioText(ratio) }),
    ...(selected ? [t("plan.selected")] : []), ...messageWords(mark, message),
  ].join(", ");
}

/** Return a joint's name for screen readers: "Joint 3, fixed, 65.0, 0.0". */
function jointLabel({ k, x, y, fixed, selected, mark, message }) {
  return [
    t("plan.joint", { joint: k }), ...(fixed ? [t("plan.fixed")] : []), shown(x), shown(y),
    ...(selected ? [t("plan.selected")] : []), ...messageWords(mark, message),
  ].join(", ");
}

function messageWords(mark, message) {
  return mark ? [`${t(mark === "error" ? "plan.error" : "plan.warning")}: ${message}`] : [];
}

/** Return the numbers of a part as [{name, value}] for what is shown at the pointer. */
export function factsOf(part) {
  const { grid } = state.document;
  if (part.joint !== undefined) {
    const height = jointHeight(state.answer, grid, part.joint);
    return [
      { name: t("plan.place"), value: grid.joints[part.joint].map((x) => shown(x)).join(", ") },
      ...(height === null ? [] : [{ name: t("plan.height"), value: `${shown(height)} mm` }]),
    ];
  }
  const [i, j] = grid.beams[part.beam];
  const heights = [i, j].map((k) => jointHeight(state.answer, grid, k));
  const known = !heights.includes(null);
  return [
    { name: t("plan.length"), value: `${shown(beamLength(grid, part.beam))} mm` },
    { name: t("plan.net"), value: `${shown(netLengths(grid, state.check, beamWidth())[part.beam])} mm` },
    { name: t("plan.angle"), value: `${shown(((beamAngle(grid, part.beam) % 180) + 180) % 180)}°` },
    ...(known ? [{ name: t("plan.height"), value: `${heights.map((z) => shown(z)).join(" / ")} mm` }] : []),
  ];
}
