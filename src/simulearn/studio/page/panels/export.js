// Exporting the shape: a format, the engine that computes it, and what each is for.

import { h, ref, useId } from "/libraries/vue.js";
import { saveExport } from "../service/files.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { Dialog, close } from "./dialog.js";

// What a person looks for, in order, and the formats of each; the page may know more than the server.
const GROUPS = {
  Picture: [".png", ".pdf", ".svg"],
  Animation: [".html", ".gif", ".mp4", ".webm"],
  Body: [".morph.glb", ".glb", ".3dm", ".stl", ".obj", ".ply"],
  Data: [".json", ".csv", ".npz", ".vtu", ".pvd"],
};

/** Return [group, formats] of what the server writes; what the page does not know is data. */
function grouped(formats) {
  const known = Object.values(GROUPS).flat();
  const others = formats.filter((one) => !known.includes(one));
  return Object.entries(GROUPS)
    .map(([name, some]) => [name, some.filter((one) => formats.includes(one))])
    .map(([name, some]) => [name, name === "Data" ? [...some, ...others] : some])
    .filter(([, some]) => some.length > 0);
}

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
          h("legend", t("common.engine")),
          (state.server?.engines ?? []).map((one) => {
            const name = words(`common.engine_${one}`) || one;
            return choice("engine", engine, one, name, words(`common.engineFor_${one}`));
          }),
        ]),
        grouped(state.server?.formats ?? []).map(([group, formats]) =>
          h("fieldset", { key: group, class: "choices" }, [
            h("legend", t(`common.formats${group}`)),
            formats.map((one) => {
              const name = one.slice(1);
              const text = words(`common.format_${name.replace(".", "_")}`);
              return choice("format", format, one, name.toUpperCase(), text);
            }),
          ])),
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
