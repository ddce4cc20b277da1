// How the document came out of a drawing: its unit, layers, curves, what was mended and what left out.
// Each choice reads the drawing again; the document is the outcome.

import { h, nextTick } from "/libraries/vue.js";
import { withEntry } from "../document/imported.js";
import { bounds } from "../document/measure.js";
import { drawingOf, readAgain, rereading } from "../service/drawings.js";
import { refuse } from "../service/files.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { NumberField, facts } from "./fields.js";
import { Mends } from "./mends.js";
import { sentence, warnings } from "./notes.js";
import { mm, ratioWords } from "./parts.js";
import { sizeWords, unitWords } from "./unit.js";

const CHORD = 0.5; // mm that straight pieces may be off a curve, at first
const QUIET = new Set(["unit", "left-out", "curves", "fixed", "moved", "reader", "actuators"]);
const ACTUATORS = ["auto", "layers", "colours", "none"];

/** Read the drawing again with other options, and say why where that fails. */
async function change(options) {
  const make = typeof options === "function" ? options : () => options;
  const refusal = await readAgain((before) => ({ ...before, ...make(before) }));
  if (refusal) refuse(refusal.file, refusal.problem, refusal.options);
}

function askUnit({ file, unit }) {
  const { width, height } = bounds(state.document.grid);
  state.dialog = {
    name: "unit", file: file.name, size: [width, height].map((x) => x / unit.mm), now: unit, choose: change,
  };
}

const section = (title, children) => h("section", { class: "part-section", "aria-label": title }, [
  h("h2", title), ...children,
]);

function head(drawing) {
  const { file, format, unit } = drawing;
  const box = bounds(state.document.grid);
  const name = unit.name === "unit" ? t("drawing.oneUnit", { mm: mm(unit.mm, 4) }) : unitWords(unit.name);
  return h("section", { class: "part-section", "aria-label": t("drawing.title") }, [
    h("div", { class: "drawing-head" }, [
      h("h2", { title: file.name }, file.name), h("span", { class: "badge" }, format),
    ]),
    facts([
      box && [t("drawing.size"), sizeWords([box.width, box.height])],
      [t("drawing.unit"), name],
    ]),
    h("p", { class: "note" }, unit.source), // in the words of the file
    h("div", { class: "row" }, [
      button(t("drawing.change"), () => askUnit(drawing)),
      button(t("drawing.done"), done, { kind: "primary" }),
    ]),
    h("p", { class: "hidden", role: "status" }, rereading.value ? t("drawing.reading") : ""),
  ]);
}

function layer(drawing, { name, colour, lines, taken, ratio }) {
  const { layers } = drawing;
  const words = name || t("drawing.noLayer");
  const names = layers.filter((one) => one.taken).map((one) => one.name);
  const last = taken && names.length === 1;
  const count = t(lines === 1 ? "drawing.lineOne" : "drawing.lineMany", { n: lines });
  return h("li", { key: name }, [
    h("label", { class: "checkbox" }, [
      h("input", {
        type: "checkbox", checked: taken, disabled: last,
        onChange: ({ target: { checked } }) =>
          change((before) => ({ layers: withEntry(before.layers ?? names, name, checked) })),
      }),
      h("svg", { class: "layer-colour", width: 12, height: 12, "aria-hidden": "true" },
        [h("rect", { width: 12, height: 12, rx: 3, fill: colour ?? "none" })]),
      h("span", { class: "layer-name", title: name }, words),
      h("span", { class: "layer-facts" }, ratio === null ? count : `${ratioWords(ratio)} · ${count}`),
    ]),
  ]);
}

function layersSection(drawing) {
  const { layers, options, messages } = drawing;
  const remarks = messages.filter(({ code, where }) => code === "actuators" && where === "colour");
  if (layers.every(({ name }) => name === "") && remarks.length === 0 && !options.actuators) return null;
  return section(t("drawing.layers"), [
    h("ul", { class: "drawing-layers" }, layers.map((one) => layer(drawing, one))),
    h("label", { class: "picker" }, [
      h("span", { class: "picker-label" }, t("drawing.actuators")),
      h("select", {
        class: "select", value: options.actuators ?? "auto",
        onChange: (event) => change({ actuators: event.target.value }),
      }, ACTUATORS.map((by) => h("option", {
        key: by, value: by, selected: by === (options.actuators ?? "auto"),
      }, t(`drawing.by_${by}`)))),
    ]),
    ...remarks.map(({ message }) => h("p", { class: "note" }, sentence(message))),
  ]);
}

function curvesSection({ options, messages }) {
  const remarks = messages.filter(({ code }) => code === "curves");
  const on = options.flatten != null;
  if (remarks.length === 0 && !on) return null;
  return section(t("drawing.curves"), [
    ...remarks.map(({ message }) => h("p", { class: "note" }, sentence(message))),
    h("label", { class: "checkbox" }, [
      h("input", {
        type: "checkbox", role: "switch", class: "switch", checked: on,
        onChange: (event) => change({ flatten: event.target.checked ? CHORD : null }),
      }), t("drawing.flatten"),
    ]),
    on && h(NumberField, {
      label: t("drawing.flattenBy"), unit: "mm", value: options.flatten, least: 0.001, most: 1000, step: 0.1,
      commit: (flatten) => change({ flatten }),
    }),
  ]);
}

function mendsSection({ mends, options }) {
  const turn = (code, done) =>
    change((before) => ({ without: withEntry(before.without ?? [], code, !done) }));
  return section(t("drawing.mends"), [
    mends.length === 0 ? h("p", { class: "note" }, t("drawing.nothing"))
      : h(Mends, { mends, onSwitch: turn }),
    h(NumberField, {
      label: t("drawing.tolerance"), unit: "mm", value: options.tolerance ?? 1, least: 0.001, most: 100, step: 0.1,
      commit: (tolerance) => change({ tolerance }),
    }),
  ]);
}

function messagesSection({ messages }) {
  const remarks = messages.filter(({ code }) => ["reader", "left-out", "moved", "fixed"].includes(code));
  if (remarks.length === 0) return null;
  return section(t("drawing.messages"), [
    h("ul", { class: "plain" }, remarks.map(({ message }, k) => h("li", { key: k }, sentence(message)))),
  ]);
}

async function done() {
  state.drawingShown = false;
  await nextTick();
  globalThis.document.querySelector(".drawing-again")?.focus();
}

/** Return a button that shows the panel again, while the document is what came out of a drawing. */
export function drawingButton() {
  const drawing = drawingOf(state.document);
  if (!drawing || state.drawingShown) return null;
  return button(t("drawing.show", { file: drawing.file.name }), async () => {
    state.drawingShown = true;
    await nextTick();
    globalThis.document.querySelector(".drawing-panel .primary")?.focus();
  }, { glyph: "file", kind: "quiet small drawing-again" });
}

export const DrawingPanel = {
  props: { drawing: Object },
  render() {
    const { drawing } = this;
    const odd = drawing.messages.filter(({ code }) => !QUIET.has(code));
    return h("div", { class: "panel drawing-panel" }, [
      head(drawing),
      odd.length > 0 && h("div", { class: "part-section" }, warnings(odd)),
      mendsSection(drawing), layersSection(drawing), curvesSection(drawing), messagesSection(drawing),
    ]);
  },
};
