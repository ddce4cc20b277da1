// Every joint and beam in a list: what the plan shows, for keyboards and screen readers.

import { computed, h, nextTick, onBeforeUnmount, ref, shallowRef, watch } from "/libraries/vue.js";
import { removeParts, stepActuators } from "../document/edit.js";
import { edit, select, state } from "../store.js";
import { t } from "../text/text.js";
import { icon } from "./icons.js";
import { beamWords, isSelected, jointWords, messagesOfParts, toggle } from "./parts.js";

const LATER = 100; // ms; numbers in the list follow a drag ten times a second

/** Return a ref of the grid that lags behind while only places and ratios change. */
function useCalmGrid() {
  const shown = shallowRef(state.document.grid);
  let timer = 0;
  const update = () => {
    clearTimeout(timer);
    timer = 0;
    shown.value = state.document.grid;
  };
  watch(() => state.document.grid, ({ joints, beams }) => {
    if (joints.length !== shown.value.joints.length || beams.length !== shown.value.beams.length) update();
    else if (timer === 0) timer = setTimeout(update, LATER);
  });
  onBeforeUnmount(() => clearTimeout(timer));
  return shown;
}

const keyOf = (kind, number) => `${kind} ${number}`;

/** One part; renders again only where something of it changes. */
const Row = {
  props: {
    id: String, name: String, detail: String, level: String, message: String,
    selected: Boolean, focusable: Boolean,
  },
  setup: (props) => () => h("div", {
    class: "part", role: "option", "data-part": props.id, "aria-selected": String(props.selected),
    "aria-label": [props.name, props.detail, props.message].filter(Boolean).join(", "),
    tabindex: props.focusable ? 0 : -1, title: props.message || undefined,
  }, [
    icon(props.id.startsWith("joints") ? "joint" : "beam", 16),
    h("span", { class: "part-name" }, props.name),
    props.level && h("span", { class: ["part-mark", props.level] }, [icon(props.level, 16)]),
    h("span", { class: "part-detail" }, props.detail),
  ]),
};

const group = (name, rows) => h("div", { role: "group", "aria-label": name }, rows);

export const Outline = {
  setup() {
    const root = ref(null);
    const focused = ref(null); // key of the row that Tab reaches
    let anchor = null; // key at which a range begins
    const grid = useCalmGrid();
    const marks = computed(() => messagesOfParts(state.check, grid.value));
    const keys = computed(() => [
      ...grid.value.joints.map((_, k) => keyOf("joints", k)),
      ...grid.value.beams.map((_, b) => keyOf("beams", b)),
    ]);
    const element = (key) => root.value?.querySelector(`[data-part="${key}"]`);
    const partOf = (key) => {
      const [kind, number] = key.split(" ");
      return [kind, Number(number)];
    };
    const hoverOf = (key) => {
      const [kind, number] = partOf(key);
      return kind === "joints" ? { joint: number } : { beam: number };
    };

    const choose = (key, event) => {
      const [kind, number] = partOf(key);
      focused.value = key;
      if (event.shiftKey && anchor) {
        const [from, to] = [keys.value.indexOf(anchor), keys.value.indexOf(key)].sort((a, b) => a - b);
        const parts = keys.value.slice(from, to + 1).map(partOf);
        select({
          joints: parts.filter(([one]) => one === "joints").map(([, n]) => n),
          beams: parts.filter(([one]) => one === "beams").map(([, n]) => n),
        });
        return;
      }
      anchor = key;
      if (event.ctrlKey || event.metaKey) toggle(kind, number);
      else select({ [kind]: [number] });
    };
    const move = async (key) => {
      focused.value = key;
      await nextTick();
      element(key)?.focus();
    };
    const onKeydown = (event) => {
      const key = event.target.dataset.part;
      if (!key) return;
      const at = keys.value.indexOf(key);
      const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: keys.value.length - 1 }[event.key];
      const [kind, number] = partOf(key);
      const parts = isSelected(kind, number) ? state.selection : { joints: [], beams: [], [kind]: [number] };
      const direction = { "+": 1, "-": -1 }[event.key];
      if (to !== undefined) {
        const next = keys.value[Math.min(keys.value.length - 1, Math.max(0, to))];
        move(next);
        if (event.shiftKey) choose(next, event);
      } else if (event.key === " " || event.key === "Enter") {
        choose(key, event);
      } else if (event.key === "a" && (event.ctrlKey || event.metaKey)) {
        const { joints, beams } = state.document.grid;
        select({ joints: joints.map((_, k) => k), beams: beams.map((_, b) => b) });
      } else if (direction) {
        const label = t("common.didRatios", { n: parts.beams.length });
        edit((document) => stepActuators(document, parts.beams, direction), { label });
      } else if (event.key === "Delete" || event.key === "Backspace") {
        edit((document) => removeParts(document, parts), { label: t("common.didDelete") });
        select({});
        nextTick(() => move(keys.value[Math.min(at, keys.value.length - 1)] ?? null));
      } else {
        return;
      }
      event.preventDefault();
      event.stopPropagation();
    };
    const rowAt = (event) => event.target.closest("[data-part]")?.dataset.part;

    // Hover is marked in the page directly: it changes with every move of the pointer over the plan.
    let marked = null;
    watch(() => state.hover, (hover) => {
      marked?.classList.remove("hover");
      const key = hover?.joint !== undefined ? keyOf("joints", hover.joint)
        : hover?.beam !== undefined ? keyOf("beams", hover.beam) : null;
      marked = key && element(key);
      marked?.classList.add("hover");
    });
    // What is selected elsewhere comes into view here.
    watch(() => state.selection, ({ joints, beams }) => {
      const key = keyOf(...(joints.length ? ["joints", joints.at(-1)] : ["beams", beams.at(-1)]));
      if (!keys.value.includes(key) || root.value?.contains(globalThis.document.activeElement)) return;
      focused.value = key;
      nextTick(() => reveal(root.value?.parentElement, element(key)));
    }, { immediate: true });

    const row = (kind, words) => (_, number) => {
      const messages = marks.value[kind].get(number) ?? [];
      const key = keyOf(kind, number);
      const { name, detail } = words(grid.value, number);
      return h(Row, {
        key, id: key, name, detail,
        level: messages.some((one) => one.kind === "error") ? "error" : messages[0]?.kind,
        message: messages.map(({ message }) => message).join("; ") || undefined,
        selected: isSelected(kind, number),
        focusable: key === (keys.value.includes(focused.value) ? focused.value : keys.value[0]),
      });
    };
    return () => {
      const { joints, beams } = grid.value;
      return h("section", { class: "outline", "aria-label": t("common.parts") }, [
        h("h2", t("common.parts")),
        h("div", {
          class: "parts", ref: root,
          role: "listbox", "aria-multiselectable": "true", "aria-label": t("common.parts"),
          onClick: (event) => rowAt(event) && choose(rowAt(event), event),
          onKeydown,
          onFocusin: (event) => { state.hover = rowAt(event) ? hoverOf(rowAt(event)) : null; },
          onFocusout: () => { state.hover = null; },
          onPointerover: (event) => { state.hover = rowAt(event) ? hoverOf(rowAt(event)) : null; },
          onPointerleave: () => { state.hover = null; },
        }, [
          group(t("common.joints"), joints.map(row("joints", jointWords))),
          group(t("common.beams"), beams.map(row("beams", beamWords))),
        ]),
      ]);
    };
  },
};

/** Scroll a list, and nothing around it, until an element of it is seen. */
function reveal(list, element) {
  if (!list || !element) return;
  const [outer, inner] = [list.getBoundingClientRect(), element.getBoundingClientRect()];
  if (inner.top < outer.top) list.scrollTop -= outer.top - inner.top;
  else if (inner.bottom > outer.bottom) list.scrollTop += inner.bottom - outer.bottom;
}
