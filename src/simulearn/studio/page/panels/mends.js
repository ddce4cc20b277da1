// What was mended in a drawing: one row for each kind, its places in the plan, and a switch.

import { h, onBeforeUnmount, ref, watch } from "/libraries/vue.js";
import { showAround } from "../plan/editor.js";
import { showPlan } from "../service/drawings.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { sentence } from "./notes.js";

// Kinds without a switch: another choice asks for them, or they are always done.
const FIXED = new Set(["flattened", "crumb", "double"]);

/** Return what was done, in the page's language, or in the server's words where it has none. */
function words({ code, count, message }) {
  const key = `drawing.mend_${code}${count === 1 ? "_one" : ""}`;
  const text = t(key, { n: count });
  return text === key ? sentence(message) : text;
}

export const Mends = {
  props: { mends: Array },
  emits: ["switch"],
  setup(props, { emit }) {
    const shown = ref(null); // { code, k }: the place that was asked for last
    const hide = () => { state.places = null; };
    const show = ({ code, places }) => {
      state.places = { points: places, current: shown.value?.code === code ? shown.value.k : null };
    };
    const next = (mend) => {
      const k = shown.value?.code === mend.code ? (shown.value.k + 1) % mend.places.length : 0;
      shown.value = { code: mend.code, k };
      showPlan();
      show(mend);
      showAround(mend.places[k]);
    };
    watch(() => props.mends, () => {
      shown.value = null;
      hide();
    });
    onBeforeUnmount(hide);
    const text = (mend) => {
      const places = mend.places.length;
      if (places === 0) return h("span", { class: "mend-text" }, words(mend));
      const at = shown.value?.code === mend.code
        && h("small", t("drawing.placeOf", { k: shown.value.k + 1, n: places }));
      return h("button", {
        type: "button", class: "mend-text", title: t("drawing.place"), onClick: () => next(mend),
        onFocus: () => show(mend), onBlur: hide, onPointerenter: () => show(mend), onPointerleave: hide,
      }, [words(mend), at]);
    };
    return () => h("ul", { class: "mends" }, props.mends.map((mend) => h("li", {
      key: mend.code, class: { off: !mend.done },
    }, [
      text(mend),
      !mend.done && h("small", t("drawing.notDone")),
      !FIXED.has(mend.code) && h("input", {
        type: "checkbox", role: "switch", class: "switch", checked: mend.done, "aria-label": words(mend),
        onChange: (event) => emit("switch", mend.code, event.target.checked),
      }),
    ])));
  },
};
