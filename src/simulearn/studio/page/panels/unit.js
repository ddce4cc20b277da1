// How large a drawing is meant to be, and curves of which it is made: what the page asks before it opens.

import { h, ref, useId } from "/libraries/vue.js";
import { heightFor, sizesBy } from "../document/imported.js";
import { view } from "../store.js";
import { formatNumber } from "../text/numbers.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { Dialog, close } from "./dialog.js";
import { NumberField } from "./fields.js";
import { sentence } from "./notes.js";

const FARTHEST = 1e5; // mm, as the server
const WIDTH = 130; // mm that are offered where nothing else speaks for a width
const CHORD = 0.5; // mm that straight pieces may be off a curve
const METRE = 1000; // mm
const OF_SURFACES = ["mm", "cm", "m", "in", "ft"]; // units

/** Return a size in mm with four digits that mean something: "130.6 × 65 mm", "33.02 × 33.02 m". */
export function sizeWords(size) {
  const [all, unit] = Math.max(...size) < 10 * METRE ? [size, "mm"] : [size.map((x) => x / METRE), "m"];
  const digits = Math.max(0, 3 - Math.floor(Math.log10(Math.max(...all, 1e-9))));
  return `${all.map((x) => formatNumber(x, view.language, Math.min(digits, 6))).join(" × ")} ${unit}`;
}

/** Return the name of a unit in the page's language, or as the server gives it. */
export function unitWords(name) {
  const key = `drawing.unit_${name}`;
  const text = t(key);
  return text === key ? name : text;
}

/** Ask for the unit, or the width, of a drawing, or the unit of a surface.
 *
 * size: width and height (and depth of a surface) in units of the file. guess: the likely unit, or null.
 * now: the unit in use, or null where none is. reason: why the page asks. choose({ unit, width }): one of
 * both is null; of a surface always the width.
 */
export const UnitDialog = {
  props: { file: String, size: Array, guess: Object, now: Object, reason: String, choose: Function },
  setup(props) {
    const id = useId();
    const flat = props.size.length === 2;
    const first = props.now ?? props.guess;
    const chosen = ref(first && first.name !== "unit" ? first.name : first ? "width" : null);
    const possible = ({ unit }) => flat || [...OF_SURFACES, first?.name].includes(unit);
    const width = ref(first ? first.mm * props.size[0] : WIDTH);
    const run = () => {
      close();
      const byWidth = chosen.value === "width";
      props.choose(byWidth ? { unit: null, width: width.value } : { unit: chosen.value, width: null });
    };
    const option = (value, title, more, tag) => h("label", { key: value, class: "choice" }, [
      h("input", {
        type: "radio", name: id, value, checked: chosen.value === value, autofocus: chosen.value === value,
        onChange: () => { chosen.value = value; },
      }),
      h("span", { class: "choice-title" }, title),
      h("span", { class: "choice-text numbers" }, [more, tag && h("span", { class: "badge" }, tag)]),
    ]);
    const tagOf = (unit) => {
      if (props.now?.name === unit) return t("drawing.unitNow");
      return !props.now && props.guess?.name === unit ? t("drawing.unitLikely") : "";
    };
    const typed = () => h("div", { class: "choice-field" }, [
      h(NumberField, {
        label: t("drawing.width"), unit: "mm", value: width.value, least: 0.001, most: FARTHEST,
        commit: (value) => { width.value = value; },
      }),
    ]);
    return () => h(Dialog, { title: t("drawing.unitTitle", { file: props.file }) }, {
      default: () => [
        props.reason && h("p", sentence(props.reason)),
        h("fieldset", { class: "choices units" }, [
          h("legend", t("drawing.unitAsk")),
          ...sizesBy(props.size, [props.guess, props.now]).filter(possible).map(({ unit, size }) =>
            option(unit, unitWords(unit), sizeWords(size), tagOf(unit))),
          flat && option("width", t("drawing.byWidth"),
            props.size[0] > 0 ? sizeWords([width.value, heightFor(props.size, width.value)]) : "–"),
          chosen.value === "width" && typed(),
        ]),
      ],
      actions: () => [
        button(t(flat ? "drawing.take" : "surface.unitTake"), run, { kind: "primary", disabled: chosen.value === null }),
        button(t("common.cancel"), close),
      ],
    });
  },
};

/** Ask how near straight pieces are to come to the curves of a drawing that has nothing else. */
export const CurvesDialog = {
  props: { file: String, reason: String, choose: Function },
  setup(props) {
    const flatten = ref(CHORD);
    const run = () => {
      close();
      props.choose({ flatten: flatten.value });
    };
    return () => h(Dialog, { title: t("drawing.curvesTitle", { file: props.file }), kind: "narrow" }, {
      default: () => [
        h("p", sentence(props.reason)),
        h(NumberField, {
          label: t("drawing.flattenBy"), unit: "mm", value: flatten.value, least: 0.001, most: FARTHEST,
          step: 0.1, commit: (value) => { flatten.value = value; },
        }),
      ],
      actions: () => [
        button(t("drawing.flatten"), run, { kind: "primary" }), button(t("common.cancel"), close),
      ],
    });
  },
};
