// A goal that vertices lie on a surface: which, whether they may slide, and what is told of its file.

import { h, onBeforeUnmount } from "/libraries/vue.js";
import { setSlide, setTolerance, setVertices, setWeight } from "../document/goals.js";
import { boxOf } from "../document/surfaces.js";
import { open } from "../service/files.js";
import { mm, number } from "../service/format.js";
import { fileOf, showPlaces } from "../service/surfaces.js";
import { edit, endMerge, state, view } from "../store.js";
import { UNITS } from "../document/imported.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { NumberField, facts } from "./fields.js";
import { goalWords, whoseWords } from "./goalwords.js";
import { sentence } from "./notes.js";
import { sizeWords, unitWords } from "./unit.js";

const MOST_WEIGHT = 1000; // only the ratios of weights count
const LEAST = 0.01; // mm, of a tolerance
const MOST = 1000;
const phone = globalThis.matchMedia("(max-width: 599px)"); // as in media.js

/** Return the vertices of the selected parts. */
function selected() {
  const { joints, beams } = state.selection;
  return [...joints.map((k) => ["joint", k, "centre"]), ...beams.map((b) => ["beam", b, "middle", "centre"])];
}

function points(goal, k) {
  const { surface, vertices } = goal;
  const own = vertices === "joints" || vertices === "beams" ? vertices : "own";
  const chosen = selected();
  const choose = (event) => {
    const next = event.target.value === "selected" ? selected() : event.target.value;
    edit((document) => setVertices(document, k, next), { label: t("surface.didPoints", { name: surface }) });
  };
  const option = (value, text, more) => h("option", { key: value, value, selected: value === own, ...more }, text);
  return h("label", { class: "field" }, [
    h("span", t("surface.points")),
    h("select", {
      class: "select", value: own, "aria-label": t("surface.pointsOf", { name: surface }), onChange: choose,
    }, [
      option("joints", t("surface.allJoints")), option("beams", t("surface.allBeams")),
      own === "own" && option("own", whoseWords(goal)),
      option("selected", t("surface.selected", { n: chosen.length }), { disabled: chosen.length === 0 }),
    ]),
  ]);
}

/** The fields of a goal on a surface. */
export function surfaceFields(goal, k) {
  const { surface, slide = true, tolerance = null, weight } = goal;
  const name = goalWords(goal);
  const change = (apply, label, merge) => {
    edit(apply, { label, merge });
    if (!merge) endMerge();
  };
  return h("div", { class: "surface-fields" }, [
    points(goal, k),
    h("label", { class: "checkbox", title: t("surface.slideHint") }, [
      h("input", {
        type: "checkbox", checked: slide, "aria-label": t("surface.slideOf", { name: surface }),
        onChange: (event) => change((document) => setSlide(document, k, event.target.checked),
          t("surface.didSlide", { name: surface })),
      }), t("surface.slide"),
    ]),
    h(NumberField, {
      key: "tolerance", label: t("surface.tolerance"), name: t("surface.toleranceOf", { name: surface }),
      value: tolerance, unit: "mm", least: LEAST, most: MOST, step: 0.1, none: t("surface.any"),
      merge: `tolerance ${k} ${surface}`,
      commit: (value, merge) => change((document) => setTolerance(document, k, value),
        t("surface.didTolerance", { name: surface }), merge),
    }),
    h(NumberField, {
      key: "weight", label: t("panels.weight"), name: t("panels.weightOf", { name }), value: weight,
      least: 0, most: MOST_WEIGHT, digits: 2, merge: `weight ${k} ${surface}`,
      commit: (value, merge) => change((document) => setWeight(document, k, value),
        t("panels.didWeight", { name }), merge),
    }),
  ]);
}

/** What is told of the file of a surface: its size and unit, what was mended and guessed, and where. */
export const SurfaceFacts = {
  props: { surface: Object },
  setup(props) {
    onBeforeUnmount(() => showPlaces(null));
    const askUnit = ({ file, options, facts: { unit, size } }) => {
      const length = UNITS[unit] ?? 1; // mm
      state.dialog = {
        name: "unit", file: file.name, size: size.map((x) => x / length), now: { name: unit, mm: length },
        choose: ({ unit: chosen }) => open(file, { ...options, meant: "surface", unit: chosen }, props.surface.name),
      };
    };
    const see = (places) => () => {
      if (view.pane === "plan") view.pane = "shape";
      showPlaces(places);
    };
    const hide = () => showPlaces(null);
    const message = ({ code, message: text, places }, n) => {
      const key = `surface.m_${code}`;
      const { triangles, apart_mm: apart } = fileOf(props.surface).facts;
      const values = { all: number(triangles), n: number(props.surface.faces.length), mm: mm(apart) };
      const words = t(key) === key ? sentence(text) : t(key, values);
      return h("li", { key: n }, places.length === 0 ? h("span", { class: "mend-text" }, words) : h("button", {
        type: "button", class: "mend-text", title: t("surface.places"), onClick: see(places),
        onFocus: see(places), onBlur: hide, onPointerenter: () => !phone.matches && showPlaces(places),
        onPointerleave: hide,
      }, [words, h("small", placesWords(places))]));
    };
    return () => {
      const told = fileOf(props.surface);
      const { low, high } = boxOf(props.surface.vertices);
      const size = sizeWords(high.map((x, axis) => x - low[axis]));
      if (!told) return facts([[t("surface.size"), size]]);
      const { unit, unit_by: by, messages } = told.facts;
      return h("div", { class: "surface-facts" }, [
        facts([
          [t("surface.size"), size],
          [t("surface.unit"), t(`surface.unit_${by}`, { unit: unitWords(unit) })],
        ]),
        button(t("surface.change"), () => askUnit(told), {
          kind: "small", "aria-label": `${t("surface.unit")}: ${t("surface.change")}`,
        }),
        messages.length > 0 && h("ul", { class: "mends" }, messages.map(message)),
      ]);
    };
  },
};

/** Return the first places [x, y, z] in words. */
function placesWords(places) {
  const first = places.slice(0, 2).map((point) => `(${point.map((x) => Math.round(x)).join(", ")})`);
  return first.join(" ") + (places.length > 2 ? " …" : "");
}
