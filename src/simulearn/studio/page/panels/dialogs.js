// What opens over the page: the dialog of state.dialog, and short confirmations.

import { h, onBeforeUnmount, onMounted, ref, useId } from "/libraries/vue.js";
import { dismiss, state } from "../store.js";
import { t } from "../text/text.js";
import { saveFile } from "../service/files.js";
import { number } from "../service/format.js";
import { keepMine, takeOther } from "../service/saving.js";
import { button, iconButton } from "./controls.js";
import { ExportDialog } from "./export.js";
import { icon } from "./icons.js";
import { HelpDialog } from "./help.js";
import { LibraryDialog } from "./library.js";
import { Dialog, close } from "./dialog.js";
import { CurvesDialog, UnitDialog } from "./unit.js";

const SHOWN = 5000; // ms that a confirmation stays
const OFFERED = 12_000; // ms where something can be done about it

const MessageDialog = {
  props: { title: String, text: String, messages: Array },
  render() {
    return h(Dialog, { title: this.title, kind: "narrow" }, {
      default: () => [
        this.text && h("p", this.text),
        this.messages?.length > 0 && h("ul", { class: "plain-messages" },
          this.messages.map(({ where, message }, i) => h("li", { key: i }, [
            where && h("strong", `${where}: `), message,
          ]))),
      ],
      actions: () => button(t("common.close"), close, { kind: "primary" }),
    });
  },
};

const ConflictDialog = {
  props: { theirs: Object },
  render() {
    const settle = (how) => () => {
      close();
      how(this.theirs);
    };
    return h(Dialog, { title: t("common.conflictTitle"), kind: "narrow" }, {
      default: () => h("p", t("common.conflictText")),
      actions: () => [
        button(t("common.conflictMine"), settle(keepMine), { kind: "primary" }),
        button(t("common.conflictTheirs"), settle(takeOther)),
      ],
    });
  },
};

const LinkDialog = {
  props: { link: String },
  setup(props) {
    const id = useId();
    const field = ref(null);
    onMounted(() => field.value?.select());
    return () => h(Dialog, { title: t("common.copyLink"), kind: "narrow" }, {
      default: () => [
        h("label", { for: id }, t("common.linkByHand")),
        h("textarea", { id, ref: field, class: "link-text", readonly: true, rows: 4, value: props.link }),
      ],
      actions: () => button(t("common.close"), close, { kind: "primary" }),
    });
  },
};

const LongLinkDialog = {
  props: { length: Number, copy: Function, without: Function },
  render() {
    const after = (run) => () => {
      close();
      run();
    };
    return h(Dialog, { title: t("surface.linkTitle"), kind: "narrow" }, {
      default: () => h("p", t("surface.linkLong", { n: number(this.length) })),
      actions: () => [
        button(t("common.saveFile"), after(() => saveFile()), { kind: "primary" }),
        button(t("surface.linkWithout"), after(this.without)),
        button(t("surface.linkAnyway"), after(this.copy)),
      ],
    });
  },
};

const WhichDialog = {
  props: { file: String, choose: Function },
  render() {
    const take = (meant) => () => {
      close();
      this.choose({ meant });
    };
    return h(Dialog, { title: t("surface.whichTitle", { file: this.file }), kind: "narrow" }, {
      default: () => h("p", t("surface.which")),
      actions: () => [
        button(t("surface.asSurface"), take("surface"), { kind: "primary" }),
        button(t("surface.asDrawing"), take("drawing")),
      ],
    });
  },
};

const DIALOGS = {
  message: MessageDialog, conflict: ConflictDialog, link: LinkDialog, long: LongLinkDialog, which: WhichDialog,
  library: LibraryDialog, export: ExportDialog, help: HelpDialog, unit: UnitDialog, curves: CurvesDialog,
};

export const Dialogs = {
  setup() {
    let shown = null;
    let key = 0; // another dialog of the same kind is a new one
    return () => {
      if (state.dialog !== shown) {
        shown = state.dialog;
        key += 1;
      }
      const { name, ...props } = shown ?? {};
      return name ? h(DIALOGS[name], { key, ...props }) : null;
    };
  },
};

const Notice = {
  props: { notice: Object },
  setup(props) {
    let timer = 0;
    const { id, action } = props.notice;
    const start = () => { timer = setTimeout(() => dismiss(id), action ? OFFERED : SHOWN); };
    const stop = () => clearTimeout(timer);
    onMounted(start);
    onBeforeUnmount(stop);
    return () => {
      const { text } = props.notice;
      const pause = { onPointerenter: stop, onPointerleave: start, onFocusin: stop, onFocusout: start };
      return h("div", { class: "notice", ...pause }, [
        h("p", text),
        action && button(action.label, () => {
          dismiss(id);
          action.run();
        }, { kind: "quiet small" }),
        iconButton("close", t("common.close"), () => dismiss(id), { class: "icon-button small" }),
      ]);
    };
  },
};

/** It floats, and goes while people work: what they aim at must not move then. */
const doing = (key, text) => h("div", { class: "notice", key }, [h("p", text)]);

/** What is seen while a file is held over the page. */
export const Drop = {
  render: () => state.dropping && h("div", { class: "drop" }, [
    h("div", [icon("open", 32), h("strong", t("common.dropHere")), h("span", t("common.dropKinds"))]),
  ]),
};

export const Notices = {
  render: () => h("div", { class: "notices", role: "status" }, [
    state.opening && doing("opening", t("common.opening", { file: state.opening })),
    ...state.notices.map((notice) => h(Notice, { key: notice.id, notice })),
  ]),
};
