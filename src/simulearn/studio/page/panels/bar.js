// The bar on top: the design's name, undo and redo, the library, files, settings.

import { h } from "/libraries/vue.js";
import { chooseFile, chooseSurface, copyLink, saveFile, saveTask } from "../service/files.js";
import { newDocument } from "../service/saving.js";
import { edit, endMerge, notify, redo, state, undo, view } from "../store.js";
import { LANGUAGES, t } from "../text/text.js";
import { Menu, button, iconButton } from "./controls.js";
import { NARROW, useMedia } from "./media.js";
import { savingState } from "./status.js";
import { PaneSwitch } from "./views.js";

const logo = () => h("svg", {
  class: "logo", viewBox: "0 0 32 32", width: 26, height: 26, "aria-hidden": "true",
}, [
  h("rect", { width: 32, height: 32, rx: 7 }),
  h("path", { d: "M6 21c6-13 14-13 20 0M6 13c6 9 14 9 20 0" }),
]);

function rename(event) {
  const name = event.target.value;
  edit((document) => (name === document.name ? document : { ...document, name }), {
    label: t("common.renamed"), merge: "name",
  });
}

const name = () => h("input", {
  class: "design-name", type: "text", value: state.document.name, maxlength: 80, spellcheck: false,
  "aria-label": t("common.name"), title: t("common.name"), placeholder: t("common.unnamed"),
  size: Math.min(28, Math.max(8, state.document.name.length + 1)),
  onInput: rename, onBlur: endMerge,
  onKeydown: (event) => {
    if (event.key === "Enter" || event.key === "Escape") event.target.blur();
  },
});

const step = (glyph, last, key, run) => iconButton(glyph, last
  ? t(`common.${key}`, { what: last.label }) : t(`common.${key}None`), run, { disabled: !last });

const dialog = (name) => () => { state.dialog = { name }; };

function begin() {
  newDocument();
  notify(t("common.newDone"), { label: t("common.back"), run: () => history.back() });
}

/** Return the items of the menu "File". */
const files = () => [
  { text: t("common.newFile"), glyph: "plus", run: begin },
  { text: t("common.openFile"), glyph: "open", hint: "Ctrl O", run: chooseFile },
  { text: t("surface.open"), glyph: "surface", run: chooseSurface },
  "-",
  { text: t("common.saveFile"), glyph: "download", hint: "Ctrl S", run: () => saveFile() },
  { text: t("common.saveGrid"), glyph: "download", run: () => saveFile({ gridOnly: true }) },
  {
    text: t("surface.saveTask"), glyph: "download", disabled: state.document.goals.length === 0, run: saveTask,
  },
  { text: t("common.exportMenu"), glyph: "hand", disabled: !state.server, run: dialog("export") },
  "-",
  { text: t("common.copyLink"), glyph: "link", run: copyLink },
];

/** Return the items of the menu "Settings". */
const settings = () => [
  { heading: t("common.theme") },
  ...["system", "light", "dark"].map((theme) => ({
    text: t(`common.theme_${theme}`), checked: view.theme === theme, run: () => { view.theme = theme; },
  })),
  "-",
  { heading: t("common.language") },
  ...Object.entries(LANGUAGES).map(([language, text]) => ({
    text, checked: view.language === language, run: () => { view.language = language; },
  })),
  "-",
  { text: t("common.help"), glyph: "help", hint: "?", run: dialog("help") },
];

export const Bar = {
  setup() {
    const narrow = useMedia(NARROW);
    return () => h("header", { class: "bar" }, [
      h("div", { class: "bar-part" }, [
        h("a", { class: "brand", href: "/", title: t("common.studio"), "aria-label": t("common.studio") },
          [logo(), h("span", { class: "wordmark" }, "SimuLearn")]),
        name(),
        savingState(),
      ]),
      !narrow.value && h(PaneSwitch, { compact: true }),
      h("div", { class: "bar-part end" }, [
        step("undo", state.history.past.at(-1), "undo", undo),
        step("redo", state.history.future.at(-1), "redo", redo),
        narrow.value ? iconButton("library", t("common.library"), dialog("library"))
          : button(t("common.library"), dialog("library"), { glyph: "library", kind: "quiet" }),
        h(Menu, { label: t("common.file"), glyph: "file", items: files(), iconOnly: narrow.value }),
        h(Menu, { label: t("common.settings"), glyph: "settings", items: settings(), iconOnly: true }),
        iconButton("help", t("common.help"), dialog("help"), { class: "icon-button wide-only" }),
      ]),
    ]);
  },
};
