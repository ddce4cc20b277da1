// The tab "Print": on which printer, what the print takes, its layers, and the file to download.

import { h, onBeforeUnmount, ref, shallowRef, watch } from "/libraries/vue.js";
import { sizeOf } from "../service/beads.js";
import { clock, grams, metres, number } from "../service/format.js";
import { printerFacts } from "../service/printers.js";
import { askPrint, downloadPrint, dropPrint, freshPrint } from "../service/printing.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { facts } from "./fields.js";
import { Layers } from "./layers.js";
import { problemNote, Reader, warnings } from "./notes.js";
import { PrinterChoice } from "./printer.js";

const SAID = "untried"; // the warning that stands beside the printer already

function printFacts({ facts: found, toolpath }) {
  const [width, depth, height] = sizeOf(toolpath);
  return facts([
    [t("print.printTime"), clock(found.seconds)],
    [t("print.heating"), clock(found.heating_seconds)],
    [t("print.filament"), `${metres(found.filament_mm)}, ${grams(found.filament_g)}`],
    [t("print.partMass"), grams(found.part_g)],
    [t("print.layersCount"), number(found.layers)],
    [t("print.printSize"), `${number(width)} × ${number(depth)} × ${number(height, 1)} mm`],
  ]);
}

/** The buttons that save the file, one for each kind that the printer takes, and what to do with it. */
const Download = {
  setup() {
    const busy = ref(null); // the format that is being written
    const problem = shallowRef(null);
    const save = async (format) => {
      busy.value = format;
      problem.value = null;
      try {
        await downloadPrint(format);
      } catch (failure) {
        problem.value = failure;
      }
      busy.value = null;
    };
    const words = (format) => {
      if (busy.value === format) return t("print.downloading");
      return t(format === "gcode" ? "print.download" : "print.downloadPackage");
    };
    return () => h("div", { class: "download" }, [
      ...(printerFacts()?.formats ?? ["gcode"]).map((format, k) => button(words(format), () => save(format), {
        key: format, glyph: "download", kind: k === 0 ? "primary" : "",
        disabled: busy.value !== null || !freshPrint() || state.print.state !== "ready",
      })),
      problem.value && problemNote(t("print.downloadFailed"), problem.value),
      h("p", { class: "note" }, t("print.beforePrint")),
      state.print.facts.brim && h("p", { class: "note" }, t("print.cutBrim")),
    ]);
  },
};

export const Print = {
  setup() {
    watch([() => state.document.grid, () => state.document.printer], askPrint, { immediate: true });
    onBeforeUnmount(dropPrint);
    const Read = Reader(() => (
      freshPrint() && state.print.state === "ready"
        ? `${t("print.printTime")} ${clock(state.print.facts.seconds)}` : ""
    ));
    return () => {
      const { print } = state;
      const old = !freshPrint();
      return h("div", { class: "panel" }, [
        h("section", { class: "part-section", "aria-label": t("print.print") }, [
          h(Read),
          h(PrinterChoice),
          !print && h("p", { class: "note" }, t("print.printEmpty")),
          print?.state === "failed" && problemNote(t("print.printFailed"), print.problem),
          print && !print.facts && print.state === "asking"
            && h("p", { class: "note", role: "status" }, t("print.printAsking")),
          print?.facts && h("div", { class: ["print-facts", { old }] }, [
            printFacts(print), ...warnings(print.facts.warnings.filter(({ code }) => code !== SAID)),
          ]),
        ]),
        print?.facts && h("section", { class: "part-section", "aria-label": t("print.download") }, [
          h(Download),
        ]),
        print?.toolpath && h(Layers, { old }),
      ]);
    };
  },
};
