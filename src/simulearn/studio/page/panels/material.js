// The material of the grid: which one, what it is, whether the learned model knows it, own files.

import { h } from "/libraries/vue.js";
import { number } from "../service/format.js";
import {
  all, chooseMaterial, chooseMaterialFile, chosenOwn, own, removeMaterial, saveMaterial,
} from "../service/materials.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { note, problemNote, sentence } from "./notes.js";

const KNOWS = { inside: "info", outside: "warning", no: "warning" };

/** The choice of a material; it is part of the document. */
function choice() {
  const { material } = state.document.grid;
  const strange = !all().some(({ name }) => name === material);
  return h("select", {
    class: "select", id: "material", value: material,
    onChange: (event) => chooseMaterial(event.target.value),
  }, [
    strange && h("option", { value: material, disabled: true }, material),
    ...all().map(({ name, title }) => h("option", { key: name, value: name },
      own.value.facts.some((one) => one.name === name) ? t("material.own", { title }) : title)),
  ]);
}

function describe({ section, strain, curl, scatter }) {
  const percent = (value) => `${number(100 * value, 1)} %`;
  const spread = scatter.print > 0 || scatter.beam > 0;
  return h("p", { class: "note numbers" }, [
    `${number(section.width, 1)} × ${number(section.thickness, 1)} mm, ${t("material.strain")} ${percent(strain)}`,
    curl !== 0 && `, ${t("material.curl")} ${curl > 0 ? "+" : ""}${percent(curl)}`,
    spread && `, ${t("material.scatter", { print: percent(scatter.print), beam: percent(scatter.beam) })}`,
    ".",
  ]);
}

/** What the learned model makes of it; nothing for the material that it is known for. */
function learned({ learned: { knows, message } }, mine) {
  if (knows === "inside" && !mine) return null;
  if (knows === "inside") return h("p", { class: "note" }, t("material.knows_inside"));
  return note(KNOWS[knows], t(`material.knows_${knows}`), [
    h("details", [h("summary", t("material.why")), h("p", sentence(message))]),
  ]);
}

export const MaterialChoice = {
  render() {
    const { material } = state;
    const { problem } = own.value;
    const mine = chosenOwn() >= 0;
    return h("div", { class: "picker" }, [
      h("label", { class: "picker-label", for: "material" }, t("common.material")),
      choice(),
      material && describe(material),
      material && learned(material, mine),
      problem && problemNote(t("material.bad"), problem),
      h("div", { class: "row" }, [
        button(t("material.open"), chooseMaterialFile, { glyph: "open", kind: "small" }),
        button(t("material.save"), saveMaterial, {
          glyph: "download", kind: "small", disabled: !material, title: t("material.saveHint"),
        }),
        mine && button(t("material.remove"), removeMaterial, { glyph: "trash", kind: "small" }),
      ]),
    ]);
  },
};
