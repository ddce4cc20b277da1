// The printer of the tab "Print": which one, what it is, whether anybody has tried it, and own profiles.

import { h, onBeforeUnmount, watch } from "/libraries/vue.js";
import { number } from "../service/format.js";
import {
  askOwn, chooseProfile, choosePrinter, fetchPrinters, known, own, printerFacts, saveProfile,
} from "../service/printers.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { icon } from "./icons.js";
import { problemNote } from "./notes.js";

const FIRMWARE = { // as their makers write them
  marlin: "Marlin", prusa: "Prusa", klipper: "Klipper", reprap: "RepRapFirmware", bambu: "Bambu Lab",
  sailfish: "Sailfish",
};
const ADDRESS = /(https:\/\/[^\s<>"')]+)/;

/** The choice of a printer; it is part of the document. */
function choice(facts) {
  const { printer } = state.document;
  const named = typeof printer === "string";
  const strange = named && !known.value.some(({ name }) => name === printer);
  return h("select", {
    class: "select", id: "printer", value: named ? printer : "",
    onChange: (event) => event.target.value && choosePrinter(event.target.value),
  }, [
    strange && h("option", { value: printer }, printer),
    !named && h("option", { value: "" }, t("print.ownProfile", { title: facts?.title ?? "…" })),
    ...known.value.map(({ name, title }) => h("option", { value: name }, title)),
  ]);
}

function describe({ bed, nozzle, firmware }) {
  const round = bed.shape === "round";
  const size = round ? `${t("print.roundBed")} ${number(bed.width)} mm`
    : `${t("print.bed")} ${number(bed.width)} × ${number(bed.depth)} mm`;
  const zones = bed.excluded.length;
  return h("p", { class: "note numbers" }, [
    `${size}, ${t("print.nozzle")} ${number(nozzle, 1)} mm, ${FIRMWARE[firmware] ?? firmware}.`,
    zones > 0 && ` ${t(zones === 1 ? "print.zone" : "print.zones", { n: zones })}`,
  ]);
}

/** A source of a profile; addresses in it are links. */
const source = (text) => h("li", { key: text }, text.split(ADDRESS).map((part, k) => (k % 2
  ? h("a", { href: part, target: "_blank", rel: "noopener noreferrer" }, part) : part)));

function trial({ tried, sources }) {
  return [
    tried
      ? h("p", { class: "note" }, t("print.tried", { tried }))
      : h("div", { class: "callout warning" }, [icon("warning", 18), h("div", [
        h("p", [h("strong", t("print.untried"))]),
        h("ol", ["untriedLook", "untriedDry", "untriedSmall"].map((key) => h("li", { key }, t(`print.${key}`)))),
      ])]),
    sources.length > 0 && h("details", [
      h("summary", t("print.sources", { n: sources.length })), h("ul", sources.map(source)),
    ]),
  ];
}

export const PrinterChoice = {
  setup() {
    fetchPrinters();
    onBeforeUnmount(watch(() => state.document.printer, askOwn, { immediate: true }));
    return () => {
      const facts = printerFacts();
      const { problem } = typeof state.document.printer === "string" ? {} : own.value;
      return h("div", { class: "picker" }, [
        h("label", { class: "picker-label", for: "printer" }, t("print.printer")),
        choice(facts),
        facts && describe(facts),
        problem && problemNote(t("print.profileBad"), problem),
        h("div", { class: "row" }, [
          button(t("print.profileOpen"), chooseProfile, { glyph: "open", kind: "small" }),
          button(t("print.profileSave"), saveProfile, {
            glyph: "download", kind: "small", disabled: !facts && !problem, title: t("print.profileSaveHint"),
          }),
        ]),
        ...(facts ? trial(facts) : []),
      ]);
    };
  },
};
