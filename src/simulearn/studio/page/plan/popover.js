// The controls of an actuator beside the beam that was clicked: its numbers, and buttons that act on
// all selected beams.

import { h } from "/libraries/vue.js";
import { bounds } from "../document/measure.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { flipBeams, ratioText, setBeams, stepBeams } from "./actions.js";
import { anyVisible, toScreen } from "./camera.js";
import { editor, isLow } from "./editor.js";
import { placeOf } from "./focus.js";
import { icon } from "./icons.js";
import { commonRatio } from "./lengths.js";
import { factsOf } from "./parts.js";
import { beside } from "./placement.js";

const SIZE = { width: 244, height: 120 }; // px, about

export const Popover = {
  render() {
    const { grid } = state.document;
    const { beams } = state.selection;
    const beam = editor.popover?.beam;
    if (!beams.includes(beam) || editor.dragging || state.tool !== "select") return null;
    const ends = grid.beams[beam].map((k) => toScreen(editor.camera, grid.joints[k]));
    if (!anyVisible(editor.camera, editor.size, [placeOf(grid, { beam })])) return null;
    const middle = toScreen(editor.camera, bounds(grid).middle);
    const [x, y] = beside(ends, middle, SIZE, editor.size, isLow() ? 8 : 64);
    const ratio = commonRatio(grid, beams);
    const title = beams.length === 1 ? t("plan.beam", { beam }) : t("plan.beams", { count: beams.length });
    return h("div", {
      class: "plan-popover", role: "group", "aria-label": `${t("plan.actuator")}: ${title}`,
      style: { transform: `translate(${Math.round(x)}px, ${Math.round(y)}px)`, width: `${SIZE.width}px` },
    }, [
      h("header", [
        h("strong", title),
        button("close", "close", () => {
          editor.popover = null;
        }),
      ]),
      beams.length === 1
        ? h("dl", factsOf({ beam }).map(({ name, value }) => h("div", [h("dt", name), h("dd", value)])))
        : null,
      h("div", { class: "controls" }, [
        button("shorter", "minus", () => stepBeams(-1), "−"),
        h("output", { class: ["value", sign(ratio)] }, ratioText(ratio)),
        button("longer", "plus", () => stepBeams(1), "+"),
        h("span", { class: "gap" }),
        button("flip", "flip", () => flipBeams(), "B", ratio === 0),
        button("remove", "none", () => setBeams(0), "0", ratio === 0),
      ]),
    ]);
  },
};

function sign(ratio) {
  if (!ratio) return "";
  return ratio > 0 ? "top" : "bottom";
}

function button(name, shape, onClick, key = "", disabled = false) {
  const label = t(`plan.${name}`);
  return h("button", {
    type: "button", class: ["plan-button", name], "aria-label": label,
    title: key ? `${label} (${key})` : label, disabled, onClick,
  }, icon(shape, 16));
}
