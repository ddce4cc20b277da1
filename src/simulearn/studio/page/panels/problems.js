// What is wrong with the grid, where, and what mends it. Errors keep it from being simulated.

import { h, ref } from "/libraries/vue.js";
import { repair, repairActuators } from "../document/repairs.js";
import { checking, startCheck } from "../service/checking.js";
import { edit, select, state, view } from "../store.js";
import { t } from "../text/text.js";
import { NOT_LEARNT } from "./check.js";
import { button } from "./controls.js";
import { icon } from "./icons.js";
import { sentence } from "./notes.js";
import { partsOf } from "./parts.js";

const FEW = 4; // messages that are shown before "show all"

/** Whether numbers in messages are those of the present grid. */
const isFresh = () => state.check.document.grid === state.document.grid;

/** What a repair is given besides its message. */
const known = () => [
  state.document, state.check.netLengths, { ...state.material?.limits, ...state.material?.section },
];

const repairButton = ({ apply, label, values }) => {
  const text = t(label, values);
  return button(text, () => edit(apply, { label: text }), { kind: "small" });
};

/** What finite elements can do for a design that the model has no shape of. */
const elementsButton = () => button(t("material.elements"), () => {
  [state.tab, view.side] = ["check", true];
  startCheck();
}, { kind: "small" });

function entry(kind, message, i, offered) {
  const { grid } = state.document;
  const fresh = isFresh();
  const parts = partsOf(message, grid);
  const somewhere = fresh && parts.joints.length + parts.beams.length > 0;
  const hover = parts.joints.length ? { joint: parts.joints[0] } : { beam: parts.beams[0] };
  const show = () => { state.hover = hover; };
  const hide = () => { state.hover = null; };
  const mend = fresh && repair(message, ...known());
  const label = mend && t(mend.label, mend.values);
  const first = label && !offered.has(label); // several messages may have one cause
  offered.add(label);
  return h("li", { key: `${message.code} ${message.where} ${i}`, class: ["message", kind] }, [
    icon(kind, 18),
    h("div", { class: "message-body" }, [
      somewhere
        ? h("button", {
          type: "button", class: "message-text", title: t("common.showPlace"),
          onClick: () => select(parts),
          onFocus: show, onBlur: hide, onPointerenter: show, onPointerleave: hide,
        }, sentence(message.message))
        : h("p", { class: "message-text" }, sentence(message.message)),
      first && repairButton(mend),
      fresh && message.code === NOT_LEARNT && !checking() && elementsButton(),
    ]),
  ]);
}

/** Return a list of messages of one kind, with a heading and at first the first few. */
function messageList(kind) {
  return {
    setup() {
      const all = ref(false);
      const showAll = () => { all.value = true; };
      return () => {
        const messages = state.check?.[`${kind}s`] ?? [];
        if (messages.length === 0) return null;
        const shown = all.value ? messages : messages.slice(0, FEW);
        const n = messages.length;
        const offered = new Set();
        const together = isFresh() && repairActuators(messages, ...known());
        return h("section", { class: ["problems", kind], "aria-label": t(`common.${kind}s`) }, [
          h("h2", t(n === 1 ? `common.${kind}Count` : `common.${kind}sCount`, { n })),
          together && repairButton(together),
          h("ul", { class: "messages" }, shown.map((message, i) => entry(kind, message, i, offered))),
          shown.length < n && button(t("common.showAll", { n }), showAll, { kind: "quiet small" }),
        ]);
      };
    },
  };
}

export const Errors = messageList("error");
export const Warnings = messageList("warning");
