// The plan of the design, and in words what qualifies the answer.

import { h, onMounted, ref } from "/libraries/vue.js";
import { number } from "/page/shape/words.js";
import { t } from "./text.js";

export const Details = {
  props: { result: Object, plan: Object },
  setup({ result, plan }) {
    const figure = ref(null);
    onMounted(() => figure.value.prepend(plan));
    const { remarks, warnings } = result;
    return () => h("aside", { class: "details", tabindex: 0, "aria-label": t("share.result") }, [
      remarks.length + warnings.length > 0 && h("section", { class: "warnings" }, [
        h("h2", t("share.warnings")),
        h("ul", { lang: "en" }, [...remarks, ...warnings.map(({ message }) => message)]
          .map((text, k) => h("li", { key: k }, text))),
      ]),
      h("section", [
        h("h2", t("share.plan")),
        h("figure", { class: "plan", ref: figure }, h("figcaption", t("share.counts", {
          joints: result.jointCount, beams: result.beamCount,
        }))),
      ]),
      h("section", [h("h2", t("share.result")), h("dl", facts(result).map(fact))]),
      h("p", { class: "made" }, t("share.made", {
        version: globalThis.document.querySelector("meta[name=generator]").content.split(" ")[1],
      })),
    ]);
  },
};

const fact = ([name, text, digest]) => [
  h("dt", { key: name }, t(`share.${name}`)),
  h("dd", [text, digest && h("code", { title: digest }, digest.slice(0, 12))]),
];

/** Return how far prints differ, and to how many shapes they come. */
function differing({ overall_mm: overall, overall_percent: percent, prints, groups }) {
  const far = t("share.differ", { mm: number(overall), percent: number(percent), prints });
  return groups.length > 1 ? `${far}; ${t("share.groups", { count: groups.length, sizes: groups.join(" + ") })}` : far;
}

/** Return [key, text, digest] of each fact. */
function facts(result) {
  const { engine, model, material, bound_mm: bound, stable, snaps, seconds, scatter } = result;
  const key = `share.engine_${engine}`;
  const reference = ["fea", "calculix"].includes(engine);
  const near = bound === null
    ? t(reference ? "share.reference" : "share.unknown")
    : t("share.near", { mm: number(bound, bound < 0.1 ? 2 : 1) });
  const percents = snaps.map(({ released }) => t("share.snap", { percent: number(100 * released, 0) }));
  return [
    ["engine", t(key) === key ? engine : t(key)],
    ...(model ? [["model", model.name, model.digest]] : []),
    ["material", material.name, material.digest],
    ["accuracy", near],
    ["balance", t(stable ? "share.stable" : "share.unstable")],
    ["snaps", percents.join(", ") || t("share.none")],
    ["range", t("share.between", { low: number(result.lowest_mm), high: number(result.highest_mm) })],
    ...(scatter ? [["scatter", differing(scatter)]] : []),
    ["time", t("share.seconds", { s: number(seconds, seconds < 1 ? 3 : 1) })],
  ];
}
