// The whole page: bar, plan and shape, side panel, status, and what opens over them.

import { h, watchEffect } from "/libraries/vue.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { Bar } from "./bar.js";
import { Dialogs, Drop, Notices } from "./dialogs.js";
import { Side } from "./side.js";
import { Status } from "./status.js";
import { Views } from "./views.js";

/** What is shown until there is a document. */
const starting = () => h("main", { class: "starting" }, [
  h("h1", t("common.studio")),
  h("p", { role: "status" }, t(state.connection === "offline" ? "common.waiting" : "common.starting")),
]);

export const App = {
  setup() {
    watchEffect(() => {
      const { name } = state.document;
      globalThis.document.title = name ? `${name} · SimuLearn` : t("common.studio");
    });
    return () => (state.started
      ? h("div", { class: "page" }, [h(Bar), h(Views), h(Side), h(Status), h(Dialogs), h(Notices), h(Drop)])
      : starting());
  },
};
