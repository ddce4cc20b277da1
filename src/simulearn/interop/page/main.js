// A result that plays without a server: the studio's shape, and beside it the plan and what
// qualifies the answer.

import { createApp, h, onBeforeUnmount, onMounted, ref } from "/libraries/vue.js";
import { parseFrames } from "/page/service/frames.js";
import { Shape } from "/page/shape/shape.js";
import { canDraw } from "/page/shape/viewer.js";
import { state, view } from "/page/store.js";
import { language } from "./browser.js";
import { Details } from "./details.js";
import { t } from "./text.js";
import { unpacked } from "./unpack.js";

const { document } = globalThis;
const picture = document.querySelector("#picture");
const plan = document.querySelector("#plan svg");
const title = document.querySelector("h1").textContent;

const Page = {
  setup() {
    const place = ref(null);
    const moves = canDraw();
    const near = ref(false); // a browser keeps few canvases: a page out of sight has none
    const watcher = new IntersectionObserver((entries) => { near.value = entries.at(-1).isIntersecting; });
    onMounted(() => watcher.observe(place.value));
    onBeforeUnmount(() => watcher.disconnect());
    return () => [
      h("header", { class: "head" }, [
        h("h1", { title }, title),
        h("button", { type: "button", class: "download", onClick: download }, t("share.download")),
      ]),
      h("main", { class: "page" }, [
        h("div", { class: "place", ref: place }, moves ? near.value && h(Shape) : h(Still)),
        h(Details, { result: state.answer.result, plan }),
      ]),
    ];
  },
};

/** The picture where nothing can move, and why. */
const Still = {
  setup() {
    const figure = ref(null);
    onMounted(() => figure.value.prepend(picture));
    return () => h("figure", { class: "still", ref: figure }, h("figcaption", t("share.noWebgl")));
  },
};

/** Save the design as the file that SimuLearn reads. */
function download() {
  const link = document.createElement("a");
  const text = JSON.stringify(state.document.grid, null, 1);
  link.href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
  link.download = `${title.normalize("NFKD").replace(/[^\w-]+/g, "-").replace(/^-+|-+$/g, "") || "grid"}.json`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // ms; the browser has read it by then
}

async function start() {
  const { grid } = JSON.parse(document.querySelector("#simulearn-result").textContent);
  const frames = await unpacked("simulearn-frames");
  const [result] = parseFrames(await frames.arrayBuffer());
  view.language = language();
  document.documentElement.lang = view.language;
  state.document = { ...state.document, grid };
  state.answer = { document: state.document, result };
  createApp(Page).mount("#share");
}

start();
