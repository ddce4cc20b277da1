// The tab "Print": on which printer, what the print takes, its layers, and the file to download.

import { h, onBeforeUnmount, ref, shallowRef, watch } from "/libraries/vue.js";
import { sizeOf } from "../service/beads.js";
import { clock, grams, metres, number } from "../service/format.js";
import { askPrint, downloadGcode, dropPrint, freshPrint } from "../service/printing.js";
import { printers } from "../service/api.js";
import { untilAnswered } from "../service/server.js";
import { edit, state } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { facts } from "./fields.js";
import { Layers } from "./layers.js";
import { problemNote, Reader, warnings } from "./notes.js";

const known = shallowRef(null); // printers of the server, once they are asked for

async function fetchPrinters() {
  if (known.value === null) known.value = (await untilAnswered(printers)).printers;
}

/** The choice of a printer; it is part of the document. */
function choice() {
  const { printer } = state.document;
  const list = known.value ?? [];
  const chosen = list.find(({ name }) => name === printer);
  const choose = (event) => {
    const next = event.target.value;
    const label = t("panels.didPrinter", { printer: list.find(({ name }) => name === next).title });
    edit((document) => ({ ...document, printer: next }), { label });
  };
  return h("div", { class: "printer" }, [
    h("label", { class: "printer-label", for: "printer" }, t("panels.printer")),
    h("select", { class: "select", id: "printer", value: printer, onChange: choose }, [
      !chosen && h("option", { value: printer }, printer),
      ...list.map(({ name, title }) => h("option", { value: name }, title)),
    ]),
    chosen && h("p", { class: "note numbers" }, [
      `${t("panels.bed")} ${number(chosen.bed.width)} × ${number(chosen.bed.depth)} mm, `,
      `${t("panels.nozzle")} ${number(chosen.nozzle, 1)} mm`,
    ]),
  ]);
}

function printFacts({ facts: found, toolpath }) {
  const [width, depth, height] = sizeOf(toolpath);
  return facts([
    [t("panels.printTime"), clock(found.seconds)],
    [t("panels.heating"), clock(found.heating_seconds)],
    [t("panels.filament"), `${metres(found.filament_mm)}, ${grams(found.filament_g)}`],
    [t("panels.layersCount"), number(found.layers)],
    [t("panels.printSize"), `${number(width)} × ${number(depth)} × ${number(height, 1)} mm`],
  ]);
}

/** The button that saves the file, and what to look at before it is printed. */
const Download = {
  setup() {
    const busy = ref(false);
    const problem = shallowRef(null);
    const saved = ref("");
    watch(() => state.print?.of, () => { saved.value = ""; });
    const save = async () => {
      busy.value = true;
      problem.value = null;
      try {
        saved.value = await downloadGcode();
      } catch (failure) {
        problem.value = failure;
      }
      busy.value = false;
    };
    return () => h("div", { class: "download" }, [
      button(t(busy.value ? "panels.downloading" : "panels.download"), save, {
        glyph: "download", kind: "primary",
        disabled: busy.value || !freshPrint() || state.print.state !== "ready",
      }),
      saved.value && h("p", { class: "note", role: "status" }, t("panels.downloaded", { file: saved.value })),
      problem.value && problemNote(t("panels.downloadFailed"), problem.value),
      h("div", { class: "callout info" }, [h("div", [
        h("p", [h("strong", t("panels.beforePrint"))]), h("p", t("panels.beforePrintNote")),
      ])]),
    ]);
  },
};

export const Print = {
  setup() {
    fetchPrinters();
    watch([() => state.document.grid, () => state.document.printer], askPrint, { immediate: true });
    onBeforeUnmount(dropPrint);
    const Read = Reader(() => (
      freshPrint() && state.print.state === "ready"
        ? `${t("panels.printTime")} ${clock(state.print.facts.seconds)}` : ""
    ));
    return () => {
      const { print } = state;
      const old = !freshPrint();
      return h("div", { class: "panel" }, [
        h("section", { class: "part-section", "aria-label": t("panels.print") }, [
          h(Read),
          choice(),
          !print && h("p", { class: "note" }, t("panels.printEmpty")),
          print?.state === "failed" && problemNote(t("panels.printFailed"), print.problem),
          print && !print.facts && print.state === "asking"
            && h("p", { class: "note", role: "status" }, t("panels.printAsking")),
          print?.facts && h("div", { class: ["print-facts", { old }] }, [
            printFacts(print), ...warnings(print.facts.warnings),
          ]),
        ]),
        print?.toolpath && h(Layers, { old }),
        print?.facts && h("section", { class: "part-section", "aria-label": t("panels.download") }, [
          h(Download),
        ]),
      ]);
    };
  },
};
