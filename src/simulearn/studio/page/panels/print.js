import { h } from "/libraries/vue.js";

export const Print = { render: () => h("div", { class: "print" }) };
