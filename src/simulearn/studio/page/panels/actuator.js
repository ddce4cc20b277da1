// The actuator of one or several beams: which half of the section is active, and along how much.

import { h } from "/libraries/vue.js";
import { setActuators, stepActuators } from "../document/edit.js";
import { edit, endMerge, state } from "../store.js";
import { t } from "../text/text.js";
import { Segmented, iconButton } from "./controls.js";
import { NumberField } from "./fields.js";
import { ratioWords } from "./parts.js";

const USUAL = 0.5; // ratio that a passive beam gets when a half is chosen
const QUARTER = 25; // %

/** Return the bar from the middle of the track to a ratio. */
const fill = (ratio) => h("span", {
  class: ["ratio-fill", ratio > 0 ? "top" : "bottom"],
  style: { left: `${50 + 50 * Math.min(0, ratio)}%`, width: `${50 * Math.abs(ratio)}%` },
});

export const Actuator = {
  props: { beams: Array },
  setup: (props) => () => {
    const { beams } = props;
    const ratios = beams.map((b) => state.document.grid.actuators[b]);
    const ratio = ratios.every((r) => r === ratios[0]) ? ratios[0] : null;
    const sides = ratios.map(Math.sign);
    const side = sides.every((s) => s === sides[0]) ? sides[0] : null;
    const label = beams.length === 1
      ? t("common.didRatio", { b: beams[0] }) : t("common.didRatios", { n: beams.length });
    const set = (value, merge = null) => {
      edit((document) => setActuators(document, beams, value), { label, merge });
      if (merge === null) endMerge();
    };
    const step = (direction) => edit((document) => stepActuators(document, beams, direction), { label });
    const turn = (sign) => edit((document) => beams.reduce((next, b) => (
      setActuators(next, [b], sign * (Math.abs(document.grid.actuators[b]) || USUAL))
    ), document), { label });
    return h("fieldset", { class: "actuator" }, [
      h("legend", t("common.actuator")),
      h(Segmented, {
        label: t("common.activeHalf"), value: side,
        options: [
          { value: -1, text: t("common.bottom"), title: t("common.bottomHint") },
          { value: 0, text: t("common.noHalf"), title: t("common.passive") },
          { value: 1, text: t("common.top"), title: t("common.topHint") },
        ],
        onChoose: turn,
      }),
      h("div", { class: "ratio" }, [
        iconButton("minus", t("common.ratioLess"), () => step(-1), { disabled: ratio === -1 }),
        h("div", { class: "ratio-track" }, [
          ratio !== null && h("div", { class: "ratio-inner" }, [fill(ratio)]),
          h("input", {
            type: "range", min: -100, max: 100, step: QUARTER, value: ratio === null ? 0 : 100 * ratio,
            "aria-label": t("common.ratio"),
            "aria-valuetext": ratio === null ? t("common.various") : ratioWords(ratio),
            onInput: (event) => set(Number(event.target.value) / 100, `ratio ${beams.join()}`),
            onChange: endMerge,
          }),
        ]),
        iconButton("plus", t("common.ratioMore"), () => step(1), { disabled: ratio === 1 }),
        h(NumberField, {
          label: "", name: t("common.ratioPercent"), unit: "%", value: ratio === null ? null : 100 * ratio,
          least: -100, most: 100, step: QUARTER, digits: 2, merge: `ratio ${beams.join()}`,
          commit: (value, merge) => set(value / 100, merge),
        }),
      ]),
      h("p", { class: "note" }, t(ratio === null ? "common.ratioVarious"
        : ratio > 0 ? "common.ratioLifts" : ratio < 0 ? "common.ratioSinks" : "common.ratioPassive")),
    ]);
  },
};
