// Exporting the shape: a format, the engine that computes it, and what each is for.

import { h, ref, useId } from "/libraries/vue.js";
import { saveExport } from "../service/files.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { Dialog, close } from "./dialog.js";

/** Return the words for a format or engine, or nothing for one that the page does not know. */
function words(key) {
  const text = t(key);
  return text === key ? "" : text;
}

export const ExportDialog = {
  setup() {
    const id = useId();
    const format = ref(state.server?.formats.includes(".glb") ? ".glb" : state.server?.formats[0]);
    const engine = ref("learned");
    const busy = ref(false);
    const error = ref("");
    const run = async () => {
      busy.value = true;
      error.value = "";
      try {
        await saveExport(format.value, engine.value);
        close();
      } catch (problem) {
        error.value = problem.message;
      }
      busy.value = false;
    };
    const choice = (name, chosen, value, title, text) => h("label", { key: value, class: "choice" }, [
      h("input", {
        type: "radio", name: `${id}-${name}`, value, checked: chosen.value === value,
        onChange: () => { chosen.value = value; },
      }),
      h("span", { class: "choice-title" }, title),
      h("span", { class: "choice-text" }, text),
    ]);
    return () => h(Dialog, { title: t("common.exportTitle") }, {
      default: () => [
        h("fieldset", { class: "choices" }, [
          h("legend", t("common.format")),
          (state.server?.formats ?? []).map((one) => {
            const name = one.slice(1);
            return choice("format", format, one, name.toUpperCase(), words(`common.format_${name}`));
          }),
        ]),
        h("fieldset", { class: "choices" }, [
          h("legend", t("common.engine")),
          (state.server?.engines ?? []).map((one) => {
            const name = words(`common.engine_${one}`) || one;
            return choice("engine", engine, one, name, words(`common.engineFor_${one}`));
          }),
        ]),
        error.value && h("p", { class: "dialog-error", role: "alert" }, error.value),
      ],
      actions: () => [
        button(busy.value ? t("common.exporting") : t("common.export", { format: format.value ?? "" }), run, {
          glyph: "download", kind: "primary", disabled: busy.value || !format.value,
        }),
        button(t("common.cancel"), close),
      ],
    });
  },
};
