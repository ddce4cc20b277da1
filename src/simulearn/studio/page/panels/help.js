// Every key of the page in one list.

import { h } from "/libraries/vue.js";
import { t } from "../text/text.js";
import { Dialog } from "./dialog.js";

const KEYS = {
  everywhere: [
    ["Ctrl Z", "undo"], ["Ctrl Shift Z", "redo"], ["Ctrl S", "save"], ["Ctrl O", "open"], ["?", "help"],
  ],
  plan: [
    ["V", "select"], ["D", "draw"], ["S", "split"], ["X", "fix"], ["+ −", "ratio"], ["0 1 2 3 4", "quarters"],
    ["B", "flip"], ["↑ ↓ ← →", "nudge"], ["Shift", "nudgeMore"], ["Alt", "nudgeLess"],
    ["Ctrl ↑ ↓ ← →", "focus"], ["M", "mirrorX"], ["Shift M", "mirrorY"], ["R", "rotate"],
    ["Delete", "delete"], ["Ctrl A", "all"], ["Ctrl C", "copy"], ["Ctrl V", "paste"], ["Ctrl D", "duplicate"],
    ["Shift F10", "menu"], ["F", "fit"],
  ],
  shape: [
    ["↑ ↓ ← →", "orbit"], ["Shift ↑ ↓ ← →", "pan"], ["+ −", "zoom"], ["F", "fit"], ["0", "home"],
    ["7", "top"], ["1", "front"], ["3", "sideways"], ["5", "projection"],
  ],
  parts: [
    ["↑ ↓", "listMove"], ["Space", "listSelect"], ["Ctrl Space", "listToggle"], ["Shift ↑ ↓", "listRange"],
    ["+ −", "ratio"], ["Delete", "delete"],
  ],
};

const entry = ([keys, text]) => h("div", { key: keys }, [
  h("dt", keys.split(" ").map((key) => h("kbd", { key }, key))),
  h("dd", t(`common.key_${text}`)),
]);

export const HelpDialog = {
  render: () => h(Dialog, { title: t("common.help"), kind: "wide", reading: true }, {
    default: () => h("div", { class: "key-groups" }, Object.entries(KEYS).map(([part, keys]) =>
      h("section", { class: "keys", key: part }, [h("h3", t(`common.${part}`)), h("dl", keys.map(entry))]))),
  }),
};
