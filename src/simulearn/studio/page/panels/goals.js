import { h } from "/libraries/vue.js";

export const Goals = { render: () => h("div", { class: "goals" }) };
