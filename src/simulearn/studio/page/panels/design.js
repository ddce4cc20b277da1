// The tab "Design": what is selected, what warns, and every part in a list.

import { h } from "/libraries/vue.js";

export const Design = {
  render: () => h("div", { class: "design" }),
};
