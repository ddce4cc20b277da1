// The whole page: bar, plan, shape, side panel and status.

import { h } from "/libraries/vue.js";
import { Plan } from "../plan/plan.js";
import { Shape } from "../shape/shape.js";

export const App = {
  render: () => h("main", { class: "views" }, [h(Plan), h(Shape)]),
};
