// What the colours mean, and the choice of what the shape is coloured by.

import { h } from "/libraries/vue.js";
import { state, view } from "../store.js";
import { t } from "../text/text.js";
import { COLOURINGS, MAPS, ticks } from "./colours.js";
import { number } from "./words.js";

const PARTS = [["top", "actuatorTop"], ["bottom", "actuatorBottom"], ["beam", "passive"], ["joint", "joint"]];

/** The legend; by: what the shape is coloured by now, range: of its values, possible: (name) -> whether
 * it could be, distance: { mean, max } to the other result where there is one. */
export const Legend = {
  props: { by: String, range: Array, possible: Function, distance: Object },
  render() {
    const { by, range, possible, distance } = this;
    const { map, unit } = COLOURINGS[by];
    const choice = Object.keys(COLOURINGS).filter((name) => name !== "deviation" || state.tab === "check");
    return h("div", { class: "shape-legend" }, [
      h("label", { class: "shape-colour" }, [
        h("span", t("shape.colourBy")),
        h("select", { value: by, onChange: (event) => { view.colour = event.target.value; } },
          choice.map((name) => h("option", { value: name, disabled: !possible(name), selected: name === by },
            t(`shape.by-${name}`)))),
        unit && h("span", { class: "unit" }, unit),
      ]),
      map === null ? h("ul", { class: "shape-keys" }, PARTS.map(([kind, text]) => h("li", { key: kind }, [
        h("span", { class: ["swatch", kind] }), t(`shape.${text}`),
      ]))) : scale(map, range),
      by === "deviation" && distance && h("p", { class: "shape-distance" }, t("shape.distance", {
        mean: number(distance.mean, 2), max: number(distance.max, 2),
      })),
    ]);
  },
};

function scale(map, range) {
  return h("div", { class: "shape-scale" }, [
    h("div", {
      class: "bar", style: { backgroundImage: `linear-gradient(to right, ${MAPS[map].join(", ")})` },
    }),
    h("div", { class: "ticks" }, ticks(range).map(({ at, value, digits }) => h("span", {
      key: at, style: { left: `${100 * at}%` },
    }, number(value, digits)))),
  ]);
}
