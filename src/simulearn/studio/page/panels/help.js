// Every key of the page in one list.

import { h } from "/libraries/vue.js";
import { t } from "../text/text.js";
import { Dialog } from "./dialog.js";

export const KEYS = [
  ["Ctrl Z", "common.key_undo"],
  ["Ctrl Shift Z", "common.key_redo"],
  ["Ctrl S", "common.key_save"],
  ["Ctrl O", "common.key_open"],
  ["?", "common.key_help"],
];
const LIST_KEYS = [
  ["↑ ↓", "common.key_listMove"],
  ["Space", "common.key_listSelect"],
  ["Ctrl Space", "common.key_listToggle"],
  ["Shift ↑ ↓", "common.key_listRange"],
  ["+ −", "common.key_listRatio"],
  ["Delete", "common.key_listDelete"],
];

const group = (title, keys) => keys.length > 0 && h("section", { class: "keys" }, [
  h("h3", title),
  h("dl", keys.map(([key, text]) => h("div", { key }, [
    h("dt", key.split(" ").map((one, i) => h("kbd", { key: i }, one))),
    h("dd", t(text)),
  ]))),
]);

export const HelpDialog = {
  render: () => h(Dialog, { title: t("common.help"), kind: "wide" }, {
    default: () => h("div", { class: "key-groups" }, [
      group(t("common.everywhere"), KEYS),
      group(t("common.parts"), LIST_KEYS),
    ]),
  }),
};
