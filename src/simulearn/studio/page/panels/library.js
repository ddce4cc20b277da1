// The library: every design with a picture of the shape that it becomes.

import { h, onBeforeUnmount, onMounted, reactive } from "/libraries/vue.js";
import { emptyDocument } from "../document/document.js";
import { keepingSurfaces } from "../document/surfaces.js";
import { thumbnail } from "../shape/thumbnail.js";
import { simulate } from "../service/api.js";
import { place } from "../service/files.js";
import { loadLibrary } from "../service/server.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { Dialog, close } from "./dialog.js";
import { icon } from "./icons.js";

const SIZE = { width: 320, height: 200 }; // pixels of a picture, twice what is shown

const pictures = reactive({ theme: "" }); // of the theme that they were drawn in: name -> data URL
let drawing = null; // the promise of drawing them, so that they are drawn once

async function draw() {
  const theme = globalThis.document.documentElement.dataset.theme;
  if (pictures.theme !== theme) {
    for (const name of Object.keys(pictures)) delete pictures[name];
    pictures.theme = theme;
  }
  const missing = (await loadLibrary()).filter(({ name }) => !pictures[name]);
  if (missing.length === 0) return;
  const results = await simulate(missing.map(({ grid }) => grid));
  for (const [i, { name }] of missing.entries()) {
    if (results[i].ok) pictures[name] = await thumbnail(results[i], SIZE);
  }
}

/** Return a design's description in the page's language, where there is one. */
function words({ name, description }) {
  const key = `common.design_${name}`;
  const text = t(key);
  return text === key ? description : text;
}

function use({ name, grid }) {
  const { grid: { material }, printer, materials } = state.document;
  close();
  const design = { ...emptyDocument(), name, grid: { ...grid, material }, printer, materials };
  place(keepingSurfaces(state.document, design), t("common.didLibrary", { name }));
}

export const LibraryDialog = {
  setup() {
    let open = true;
    onMounted(() => {
      drawing ??= draw().catch(() => {
        // Without pictures the names and descriptions are still there to choose from.
      }).finally(() => { drawing = null; });
    });
    onBeforeUnmount(() => { open = false; });
    return () => open && h(Dialog, { title: t("common.library"), kind: "wide" }, {
      default: () => [
        h("p", { class: "note" }, t("common.libraryNote")),
        h("ul", { class: "cards" }, state.library.map((design) => h("li", { key: design.name }, [
          h("button", { type: "button", class: "card", onClick: () => use(design) }, [
            h("span", { class: "card-picture" }, pictures[design.name]
              ? [h("img", { src: pictures[design.name], alt: "", width: 160, height: 100 })]
              : [icon("shape", 28)]),
            h("span", { class: "card-name" }, design.name),
            h("span", { class: "card-text" }, words(design)),
          ]),
        ]))),
      ],
    });
  },
};
