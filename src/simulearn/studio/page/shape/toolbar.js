// The buttons of the view: where it is seen from, and what is drawn with the shape.

import { h, onBeforeUnmount, ref } from "/libraries/vue.js";
import { state, view } from "../store.js";
import { t } from "../text/text.js";
import { icon } from "./icons.js";

const VIEWS = [["fit", "F"], ["home", "0"], ["top", "7"], ["front", "1"], ["side", "3"]];
const SHOWN = ["ghost", "ground", "dimensions", "heights"];

export const Toolbar = {
  props: { run: Function, printing: Boolean },
  render() {
    const { run, printing } = this;
    const projection = view.parallel ? "parallel" : "perspective";
    return h("div", {
      class: "shape-toolbar", role: "toolbar", "aria-label": t("shape.views"), "aria-orientation": "vertical",
    }, [
      ...VIEWS.map(([name, key]) => button(name, key, () => run(name))),
      button(projection, "5", () => { view.parallel = !view.parallel; }),
      !printing && h(Display),
    ]);
  },
};

/** The menu of what is drawn with the shape. */
const Display = {
  setup() {
    const open = ref(false);
    const root = ref(null);
    const close = (event) => {
      if (open.value && !root.value.contains(event.target)) open.value = false;
    };
    globalThis.addEventListener("pointerdown", close, true);
    onBeforeUnmount(() => globalThis.removeEventListener("pointerdown", close, true));
    const onKeydown = (event) => {
      if (event.key !== "Escape" || !open.value) return;
      event.stopPropagation();
      open.value = false;
      root.value.querySelector("button").focus();
    };
    return () => h("div", { class: "shape-display", ref: root, onKeydown }, [
      h("button", {
        type: "button", class: "shape-button", "aria-label": t("shape.display"), title: t("shape.display"),
        "aria-expanded": open.value, onClick: () => { open.value = !open.value; },
      }, icon("display")),
      open.value && h("div", { class: "shape-menu", role: "group", "aria-label": t("shape.display") }, [
        ...SHOWN.map(toggle), state.tab === "check" && state.fea?.result && toggle("overlay"),
      ]),
    ]);
  },
};

const toggle = (name) => h("label", { key: name }, [
  h("input", {
    type: "checkbox", checked: view[name], onChange: (event) => { view[name] = event.target.checked; },
  }),
  t(`shape.show-${name}`),
]);

function button(name, key, onClick) {
  const label = t(`shape.view-${name}`);
  return h("button", {
    type: "button", key: name, class: "shape-button", "aria-label": label, title: `${label} (${key})`,
    onClick,
  }, icon(name));
}
