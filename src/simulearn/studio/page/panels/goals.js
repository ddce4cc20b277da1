// The tab "Goals": where points of the shape are wanted, single changes that bring them there, and a
// search that changes everything at once.

import { h } from "/libraries/vue.js";
import { state } from "../store.js";
import { GoalList } from "./goallist.js";
import { SearchPanel } from "./search.js";
import { Suggestions } from "./suggestions.js";

export const Goals = {
  render: () => h("div", { class: "panel" }, [
    h(GoalList),
    state.document.goals.length > 0 && h(Suggestions),
    (state.document.goals.length > 0 || state.search) && h(SearchPanel),
  ]),
};
