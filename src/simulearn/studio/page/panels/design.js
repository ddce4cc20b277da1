// The tab "Design": what is selected, what warns, and every part in a list.

import { h } from "/libraries/vue.js";
import { Inspector } from "./inspector.js";
import { Outline } from "./outline.js";
import { Warnings } from "./problems.js";

export const Design = {
  render: () => h("div", { class: "design" }, [
    h("div", { class: "design-top" }, [h(Inspector)]), h(Warnings), h(Outline),
  ]),
};
