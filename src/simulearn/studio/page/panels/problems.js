// What is wrong with the grid, where, and what mends it.

import { h } from "/libraries/vue.js";
import { state } from "../store.js";
import { icon } from "./icons.js";

export const Errors = {
  render: () => {
    const errors = state.check?.errors ?? [];
    return h("ul", { class: "messages" }, errors.map(({ message }, i) => h("li", { key: i, class: "message error" }, [
      icon("error"), h("p", message),
    ])));
  },
};
