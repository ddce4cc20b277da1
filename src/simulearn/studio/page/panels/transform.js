// Turning, mirroring and scaling: the selection, or everything.

import { h, ref } from "/libraries/vue.js";
import { mirror, rotate, scale } from "../document/edit.js";
import { edit } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { NumberField } from "./fields.js";

export const Transform = {
  props: { selection: Object }, // null: all
  setup(props) {
    const degrees = ref(15);
    const percent = ref(110);
    const turn = () => edit((document) => rotate(document, props.selection, degrees.value), {
      label: t("common.didRotate", { degrees: degrees.value }),
    });
    const size = () => edit((document) => scale(document, percent.value / 100), {
      label: t("common.didScale", { percent: percent.value }),
    });
    const reflect = (axis) => () => edit((document) => mirror(document, props.selection, axis), {
      label: t("common.didMirror"),
    });
    return () => h("div", { class: "transform", role: "group", "aria-label": t("common.transform") }, [
      h("div", { class: "row" }, [
        h(NumberField, {
          label: t("common.angle"), unit: "°", value: degrees.value, least: -360, most: 360, step: 15,
          commit: (value) => { degrees.value = value; },
        }),
        button(t("common.rotate"), turn, { glyph: "rotate" }),
      ]),
      props.selection === null && h("div", { class: "row" }, [
        h(NumberField, {
          label: t("common.factor"), unit: "%", value: percent.value, least: 1, most: 1000, step: 10,
          commit: (value) => { percent.value = value; },
        }),
        button(t("common.scale"), size, { glyph: "scale" }),
      ]),
      h("div", { class: "row" }, [
        button(t("common.mirrorX"), reflect("x"), { glyph: "mirrorX", title: t("common.mirrorXHint") }),
        button(t("common.mirrorY"), reflect("y"), { glyph: "mirrorY", title: t("common.mirrorYHint") }),
      ]),
    ]);
  },
};
