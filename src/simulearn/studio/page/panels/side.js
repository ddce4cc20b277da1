// The side panel: four tabs on one document.

import { h } from "/libraries/vue.js";
import { state, view } from "../store.js";
import { t } from "../text/text.js";
import { Check } from "./check.js";
import { iconButton, rove } from "./controls.js";
import { Design } from "./design.js";
import { Goals } from "./goals.js";
import { Print } from "./print.js";
import { Errors } from "./problems.js";

const TABS = { design: Design, goals: Goals, check: Check, print: Print };

export const Side = {
  setup() {
    const choose = (name) => {
      state.tab = name;
      view.side = true;
    };
    const onKeydown = (event) => {
      rove(event, [...event.currentTarget.querySelectorAll("[role=tab]")])?.click();
    };
    const tab = (name) => h("button", {
      key: name, type: "button", role: "tab", id: `tab-${name}`, "aria-controls": view.side ? "tab-panel" : undefined,
      "aria-selected": String(state.tab === name), tabindex: state.tab === name ? 0 : -1,
      onClick: () => choose(name),
    }, t(`common.tab_${name}`));
    return () => h("aside", { class: ["side", { closed: !view.side }], "aria-label": t("common.side") }, [
      h("div", { class: "side-head" }, [
        h("div", { class: "tabs", role: "tablist", "aria-label": t("common.side"), onKeydown },
          Object.keys(TABS).map(tab)),
        iconButton("chevron", t(view.side ? "common.sideClose" : "common.sideOpen"), () => {
          view.side = !view.side;
        }, { class: "icon-button side-toggle", "aria-expanded": String(view.side) }),
      ]),
      view.side && h("div", {
        class: "side-body", role: "tabpanel", id: "tab-panel", tabindex: -1,
        "aria-labelledby": `tab-${state.tab}`,
      }, [h(Errors), h(TABS[state.tab] ?? Design, { key: state.tab })]),
    ]);
  },
};
