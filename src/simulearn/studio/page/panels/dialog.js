// The frame of every dialog: a native <dialog>, which traps the focus and gives it back.

import { h, onBeforeUnmount, onMounted, ref, useId } from "/libraries/vue.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { iconButton } from "./controls.js";

/** Close the open dialog. */
export function close() {
  state.dialog = null;
}

/** Slots: default, and actions at its bottom. reading: there is nothing in it to go to by keys but its text. */
export const Dialog = {
  props: { title: String, kind: String, reading: Boolean },
  setup(props, { slots }) {
    const root = ref(null);
    const id = useId();
    const own = state.dialog;
    const onClose = () => {
      if (state.dialog === own) close(); // not the one that has taken its place
    };
    onMounted(() => root.value.showModal());
    onBeforeUnmount(() => root.value.close());
    return () => h("dialog", {
      ref: root, class: ["dialog", props.kind], "aria-labelledby": id,
      onClose,
      onClick: (event) => event.target === root.value && close(), // beside it
    }, [
      h("div", { class: "dialog-frame" }, [
        h("div", { class: "dialog-head" }, [
          h("h2", { id }, props.title),
          iconButton("close", t("common.close"), close),
        ]),
        h("div", { class: "dialog-body", tabindex: props.reading ? 0 : undefined }, slots.default()),
        slots.actions && h("div", { class: "dialog-actions" }, slots.actions()),
      ]),
    ]);
  },
};
