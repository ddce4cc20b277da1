import { h } from "/libraries/vue.js";

export const Check = { render: () => h("div", { class: "check" }) };
