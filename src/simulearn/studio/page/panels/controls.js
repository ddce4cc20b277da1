// Small controls that the panels share: buttons with icons, a choice of a few, menus.

import { h, nextTick, onBeforeUnmount, ref, watch } from "/libraries/vue.js";
import { icon } from "./icons.js";

/** Return a button that shows an icon only; `name` is its accessible name and its tooltip. */
export function iconButton(glyph, name, onClick, rest = {}) {
  return h("button", {
    type: "button", class: "icon-button", "aria-label": name, title: name, onClick, ...rest,
  }, [icon(glyph)]);
}

/** Return a button with a word and, before it, an icon. */
export function button(text, onClick, { glyph = null, kind = "", ...rest } = {}) {
  return h("button", { type: "button", class: ["button", kind], onClick, ...rest }, [
    glyph && icon(glyph, 18), h("span", text),
  ]);
}

/** Keep the arrow keys, Home and End within a row or column of elements. */
export function rove(event, elements) {
  const at = elements.indexOf(globalThis.document.activeElement);
  const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[event.key];
  let next = null;
  if (step && at >= 0) next = elements[(at + step + elements.length) % elements.length];
  else if (step) next = elements[step > 0 ? 0 : elements.length - 1];
  if (event.key === "Home") next = elements[0];
  if (event.key === "End") next = elements.at(-1);
  if (!next) return null;
  event.preventDefault();
  event.stopPropagation();
  next.focus();
  return next;
}

/** A choice of a few, as a group of radio buttons: options are { value, text, glyph?, title? }. */
export const Segmented = {
  props: { label: String, value: [String, Number], options: Array, compact: Boolean },
  emits: ["choose"],
  setup(props, { emit }) {
    const onKeydown = (event) => {
      const next = rove(event, [...event.currentTarget.querySelectorAll("button:not(:disabled)")]);
      if (next) next.click();
    };
    return () => {
      const chosen = props.options.some(({ value }) => value === props.value);
      return h("div", { class: "segmented", role: "radiogroup", "aria-label": props.label, onKeydown },
        props.options.map(({ value, text, glyph, title }, i) => h("button", {
          type: "button", role: "radio", key: value,
          "aria-checked": String(value === props.value),
          "aria-label": props.compact ? text : undefined,
          tabindex: value === props.value || (!chosen && i === 0) ? 0 : -1,
          title: title ?? (props.compact ? text : undefined),
          onClick: () => emit("choose", value),
        }, [glyph && icon(glyph, 18), !props.compact && h("span", text)])));
    };
  },
};

/** A button that opens a menu.
 *
 * items: { text, hint?, glyph?, run, checked?, disabled? }, "-" for a line, { heading }. An item with
 * `checked` is one of a choice and leaves the menu open.
 */
export const Menu = {
  props: { label: String, glyph: String, items: Array, iconOnly: Boolean },
  setup(props) {
    const open = ref(false);
    const root = ref(null);
    const entries = () => [...root.value.querySelectorAll("[role^=menuitem]:not(:disabled)")];
    const close = (focus = true) => {
      open.value = false;
      if (focus) root.value?.querySelector("button").focus();
    };
    const show = async (last = false) => {
      open.value = true;
      await nextTick();
      entries().at(last ? -1 : 0)?.focus();
    };
    const outside = (event) => {
      if (!root.value?.contains(event.target)) close(false);
    };
    watch(open, (is) => {
      const change = is ? "addEventListener" : "removeEventListener";
      globalThis.document[change]("pointerdown", outside, true);
    });
    onBeforeUnmount(() => globalThis.document.removeEventListener("pointerdown", outside, true));
    const onKeydown = (event) => {
      if (!open.value) {
        if (event.key === "ArrowDown" || event.key === "ArrowUp") {
          event.preventDefault();
          show(event.key === "ArrowUp");
        }
      } else if (event.key === "Escape") {
        event.stopPropagation();
        close();
      } else if (event.key === "Tab") {
        close(false);
      } else {
        rove(event, entries());
      }
    };
    const run = (item) => {
      if (item.checked === undefined) close();
      item.run();
    };
    const entry = (item, i) => {
      if (item === "-") return h("div", { key: i, role: "separator", class: "menu-line" });
      if (item.heading)
        return h("div", { key: i, class: "menu-heading", role: "presentation" }, item.heading);
      const choice = item.checked !== undefined;
      return h("button", {
        key: i, type: "button", role: choice ? "menuitemradio" : "menuitem", tabindex: -1,
        "aria-checked": choice ? String(item.checked) : undefined, disabled: item.disabled,
        onClick: () => run(item),
      }, [
        choice ? h("span", { class: "menu-mark" }, item.checked ? [icon("check", 16)] : [])
          : item.glyph && icon(item.glyph, 18),
        h("span", { class: "menu-text" }, item.text),
        item.hint && h("kbd", item.hint),
      ]);
    };
    return () => h("div", { class: "menu-root", ref: root, onKeydown }, [
      h("button", {
        type: "button", class: props.iconOnly ? "icon-button" : "button quiet",
        "aria-label": props.iconOnly ? props.label : undefined,
        title: props.iconOnly ? props.label : undefined,
        "aria-haspopup": "menu", "aria-expanded": String(open.value),
        onClick: () => (open.value ? close() : show()),
      }, props.iconOnly ? [icon(props.glyph)] : [
        icon(props.glyph, 18), h("span", props.label), icon("chevron", 14),
      ]),
      open.value && h("div", { class: "menu", role: "menu", "aria-label": props.label },
        props.items.map(entry)),
    ]);
  },
};
