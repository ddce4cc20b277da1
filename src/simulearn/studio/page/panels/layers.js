// The layers of a print: which one is looked at, its travels, and what is printed on it.

import { computed, h } from "/libraries/vue.js";
import { lengthsOf } from "../service/beads.js";
import { metres, number } from "../service/format.js";
import { showLayer, showTravels } from "../service/printing.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { iconButton } from "./controls.js";

/** Return the colours of a role: actuators of the upper half of the section have one of their own. */
const swatch = (role, layer, all) => (role === "active" && 2 * (layer - 1) >= all ? "active upper" : role);

export const Layers = {
  props: { old: Boolean },
  setup(props) {
    const lengths = computed(() => lengthsOf(state.print.toolpath, state.print.layer));
    const onWheel = (event) => {
      if (event.target !== globalThis.document.activeElement) return;
      event.preventDefault();
      showLayer(state.print.layer - Math.sign(event.deltaY));
    };
    return () => {
      const { toolpath, layer, travels } = state.print;
      const all = toolpath.layers.length;
      const top = `${number(toolpath.layers[layer - 1].z, 2)} mm`;
      const value = t("print.layerOf", { n: layer, all, mm: top });
      const length = (role) => lengths.value.get(role);
      return h("section", { class: ["part-section", { old: props.old }], "aria-label": t("print.layer") }, [
        h("div", { class: "layer-head" }, [
          h("h2", t("print.layer")), h("span", { class: "note numbers" }, value),
        ]),
        h("div", { class: "steps-row" }, [
          iconButton("minus", t("print.layerDown"), () => showLayer(layer - 1),
            { class: "icon-button small", disabled: layer === 1 }),
          h("input", {
            type: "range", min: 1, max: all, step: 1, value: layer,
            "aria-label": t("print.layer"), "aria-valuetext": value,
            onInput: (event) => showLayer(Number(event.target.value)), onWheel,
          }),
          iconButton("plus", t("print.layerUp"), () => showLayer(layer + 1),
            { class: "icon-button small", disabled: layer === all }),
        ]),
        h("label", { class: "checkbox" }, [
          h("input", {
            type: "checkbox", role: "switch", checked: travels,
            onChange: (event) => showTravels(event.target.checked),
          }), t("print.travels"),
        ]),
        travels && h("ul", { class: "legend travels" }, ["drawn", "kept"].map((kind) => h("li", { key: kind }, [
          h("span", { class: ["travel", kind], "aria-hidden": "true" }), h("span", t(`print.travel_${kind}`)),
        ]))),
        h("h3", t("print.legend")),
        h("ul", { class: "legend" }, toolpath.roles.map((role) => h("li", {
          key: role, class: { none: length(role) === 0 },
        }, [
          h("span", { class: ["swatch", swatch(role, layer, all)], "aria-hidden": "true" }),
          h("span", t(`print.role_${role}`)),
          h("span", { class: "numbers" }, length(role) ? metres(length(role)) : "–"),
        ]))),
      ]);
    };
  },
};
