// Plan and shape side by side with a divider between them, or one of them.

import { computed, h, ref } from "/libraries/vue.js";
import { Plan } from "../plan/plan.js";
import { Shape } from "../shape/shape.js";
import { view } from "../store.js";
import { t } from "../text/text.js";
import { Segmented, iconButton } from "./controls.js";
import { NARROW, PHONE, useMedia } from "./media.js";

const LEAST = 0.2; // part of the width that each view keeps
const GONE = 0.1; // drawn below this part, a view is closed
const STEP = 0.02; // of an arrow key

const clamp = (share) => Math.min(1 - LEAST, Math.max(LEAST, share));

/** The choice of the views that are shown. */
export const PaneSwitch = {
  props: { compact: Boolean },
  setup(props) {
    const phone = useMedia(PHONE);
    return () => {
      const options = [
        { value: "plan", text: t("common.plan"), glyph: "plan" },
        { value: "both", text: t("common.both"), glyph: "both" },
        { value: "shape", text: t("common.shape"), glyph: "shape" },
      ];
      return h(Segmented, {
        class: "pane-switch", label: t("common.panes"), compact: props.compact,
        options: phone.value ? options.filter(({ value }) => value !== "both") : options,
        value: phone.value && view.pane === "both" ? "shape" : view.pane,
        onChoose: (pane) => { view.pane = pane; },
      });
    };
  },
};

export const Views = {
  setup() {
    const root = ref(null);
    const phone = useMedia(PHONE);
    const narrow = useMedia(NARROW);
    const pane = computed(() => (phone.value && view.pane === "both" ? "shape" : view.pane));
    const shareAt = (event) => {
      const box = root.value.getBoundingClientRect();
      return (event.clientX - box.left) / box.width;
    };
    const drag = (event) => {
      if (!event.currentTarget.hasPointerCapture(event.pointerId)) return;
      view.share = clamp(shareAt(event));
    };
    const drop = (event) => {
      const share = shareAt(event);
      if (event.type !== "pointerup" || (share >= GONE && share <= 1 - GONE)) return;
      view.pane = share < GONE ? "shape" : "plan";
      view.share = 0.5;
    };
    const key = (event) => {
      const step = { ArrowLeft: -STEP, ArrowUp: -STEP, ArrowRight: STEP, ArrowDown: STEP }[event.key];
      if (step) view.share = clamp(view.share + step);
      else if (event.key === "Home") view.share = LEAST;
      else if (event.key === "End") view.share = 1 - LEAST;
      else if (event.key === "Enter") view.share = 0.5;
      else return;
      event.preventDefault();
    };
    const divider = () => h("div", {
      class: "divider", role: "separator", tabindex: 0,
      "aria-orientation": "vertical",
      "aria-label": t("common.divider"), title: t("common.dividerHint"),
      "aria-valuemin": LEAST * 100, "aria-valuemax": (1 - LEAST) * 100,
      "aria-valuenow": Math.round(view.share * 100),
      onPointerdown: (event) => {
        event.preventDefault();
        event.currentTarget.setPointerCapture(event.pointerId);
      },
      onPointermove: drag, onPointerup: drop, onDblclick: () => { view.share = 0.5; }, onKeydown: key,
    });
    const closeTip = () => { view.tip = false; };
    return () => h("main", { class: "main" }, [
      h("h1", { class: "hidden" }, t("common.studio")),
      narrow.value && h(PaneSwitch),
      view.tip && h("div", { class: "tip" }, [
        h("p", t("common.tip")),
        iconButton("close", t("common.tipClose"), closeTip, { class: "icon-button small" }),
      ]),
      h("div", {
        class: ["views", pane.value], ref: root,
        style: { "--plan": `${view.share}fr`, "--shape": `${1 - view.share}fr` },
      }, [
        h("div", { class: "pane plan-pane", key: "plan" }, [h(Plan)]),
        pane.value === "both" && divider(),
        h("div", { class: "pane shape-pane", key: "shape" }, [h(Shape)]),
      ]),
    ]);
  },
};
