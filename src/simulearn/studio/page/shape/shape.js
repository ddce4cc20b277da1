// The shape: the morphing grid in space, frame by frame, with what is written over it.

import { computed, h, onBeforeUnmount, onMounted, ref, shallowRef, watch } from "/libraries/vue.js";
import { preparing, select, stale, state, view } from "../store.js";
import { t } from "../text/text.js";
import { comparisonOf } from "./compared.js";
import { deviation } from "./deviation.js";
import { Legend } from "./legend.js";
import { handlesOf, noteItems } from "./notes.js";
import { placedResult } from "./placed.js";
import { Playback, togglePlay } from "./playback.js";
import { Summary } from "./summary.js";
import { Toolbar } from "./toolbar.js";
import { createTriad } from "./triad.js";
import { hasValues } from "./values.js";
import { canDraw, createViewer } from "./viewer.js";
import { moment, summaryOf } from "./words.js";

const NONE = [];
const LATE = 150; // ms that a shape may be of an earlier design before it is dimmed
const QUIET = 900; // ms without a change until the shape is read out
const DIM = 0.55; // of the shape's colours towards the canvas
const PREFERS_STILL = globalThis.matchMedia("(prefers-reduced-motion: reduce)");

/** Return what is drawn: { own, result, grid, label } of the preview, else of the answer; or null.
 *
 * result is `own`, the engine's, or where that is compared with goals, if it may be placed anywhere.
 */
function source() {
  const { preview, answer } = state;
  if (preview?.result && preview.result.ok !== false) {
    const { result: own, label } = preview;
    return { own, result: compared(own), grid: preview.grid ?? preview.document?.grid ?? own.grid, label };
  }
  if (!answer) return null;
  const { result: own, document: { grid } } = answer;
  return { own, result: compared(own), grid, label: "" };
}

/** Return a result in the place where it is compared with goals. */
function compared(result) {
  if (state.document.pose !== "free" || state.tab !== "goals") return result;
  const { place } = comparisonOf(result) ?? {};
  return place ? placedResult(result, place) : result;
}

/** Return the result of the check by finite elements, where it is of the shown grid. */
function otherResult() {
  const { fea, answer, tab, preview } = state;
  if (tab !== "check" || preview || !fea?.result || !answer) return null;
  return fea.document.grid === answer.document.grid ? fea.result : null;
}

/** Return the axes of prints of the shown grid, where they were asked for. */
function shownPrints() {
  const { spread, answer, tab, preview } = state;
  if (tab !== "check" || preview || !spread?.result?.prints || !answer) return null;
  return spread.document.grid === answer.document.grid ? spread.result.prints : null;
}

export const Shape = {
  setup() {
    const container = ref(null);
    const viewer = shallowRef(null);
    const broken = ref(""); // why nothing is drawn: "missing", "lost"
    const late = ref(false);
    const said = ref("");
    const shown = shallowRef(null); // what the viewer has: { result, grid, label }
    const coloured = shallowRef({ by: "actuator", range: [0, 1] });
    const errors = computed(() => (
      state.check?.document.grid === state.document.grid && state.check.errors.length > 0
    ));
    const other = computed(otherResult);
    const printing = computed(() => state.tab === "print" && Boolean(state.print?.toolpath));
    const goals = computed(() => state.tab === "goals");
    const prints = computed(shownPrints);
    const surfaces = computed(() => (goals.value ? state.document.surfaces : NONE));
    const distance = computed(() => (other.value && shown.value
      ? deviation(shown.value.result, other.value, Math.round(view.frame)) : null));
    let [triad, dimmer, reader] = [null, 0, 0];
    let placed = state.placed; // when all of the shape was last brought into view for a new design

    const colour = () => {
      const by = hasValues(view.colour, shown.value?.result, other.value) ? view.colour : "actuator";
      viewer.value.setColour(by, other.value);
      coloured.value = { by, range: viewer.value.body.range };
    };
    const marks = () => {
      const { joints, beams } = state.selection;
      viewer.value.setMarks({ joints, beams, hover: state.hover });
    };
    const notes = () => {
      const on = shown.value && !printing.value;
      viewer.value.setNotes(
        on ? noteItems(viewer.value, shown.value, { goals: goals.value }) : [],
        on && goals.value ? handlesOf(viewer.value) : null,
      );
    };
    const show = () => {
      shown.value = source();
      viewer.value.show(shown.value?.result ?? null, shown.value?.grid ?? null);
      viewer.value.overlay(view.overlay ? other.value : null);
      if (placed !== state.placed && !stale.value) {
        placed = state.placed;
        viewer.value.fit();
      }
      colour();
      marks();
      notes();
    };
    const begin = () => {
      viewer.value = createViewer(container.value, {
        still: () => PREFERS_STILL.matches,
        events: {
          onHover: (part) => { state.hover = part ? { [part.kind]: part.number } : null; },
          onPress: press,
          onCamera: () => triad?.turn(viewer.value.camera.camera),
          onLost: () => { broken.value = "lost"; },
          onRestored: () => { broken.value = ""; },
        },
      });
      triad = createTriad(container.value, (name) => viewer.value.command(name));
      triad.turn(viewer.value.camera.camera);
      viewer.value.setFrame(view.frame);
      viewer.value.setGhost(view.ghost);
      show();
      watchState();
    };
    const watchState = () => {
      watch(source, show); // a new object each time, so whenever the answer or preview is replaced
      watch(other, () => {
        viewer.value.overlay(view.overlay ? other.value : null);
        colour();
      });
      watch(prints, (centres) => viewer.value.setPrints(centres), { immediate: true });
      watch(() => view.overlay, (on) => viewer.value.overlay(on ? other.value : null));
      watch(() => view.colour, colour);
      watch(() => view.ghost, (on) => viewer.value.setGhost(on));
      watch(() => view.ground && shown.value?.result === shown.value?.own, (on) => viewer.value.setGround(on),
        { immediate: true });
      watch(surfaces, (list) => viewer.value.setSurfaces(list), { immediate: true });
      watch(() => view.dimensions, (on) => viewer.value.setRoomy(on), { immediate: true });
      watch(() => view.parallel, (on) => viewer.value.camera.setParallel(on), { immediate: true });
      watch(() => [state.selection, state.hover], marks);
      watch(() => view.playing, (on) => viewer.value.setPlaying(on));
      watch(() => view.frame, (frame) => viewer.value.setFrame(frame), { flush: "sync" });
      watch(() => [
        view.frame, view.dimensions, view.heights, view.language, goals.value, printing.value,
        state.pickVertex, goals.value && state.document.goals, state.selection.goal, state.hover?.goal,
        goals.value && state.measured, state.spots,
      ], notes);
      watch(() => [printing.value && state.print.toolpath, state.print?.layer, state.print?.travels], () => {
        const path = printing.value ? state.print.toolpath : null;
        viewer.value.setPrint(path, path?.bed ?? null);
        if (path) viewer.value.setLayer(state.print.layer, state.print.travels);
      }, { immediate: true });
      watch(() => !state.preview && (errors.value || stale.value), (is) => {
        clearTimeout(dimmer);
        if (is) dimmer = setTimeout(() => { late.value = true; }, LATE);
        else late.value = false;
      }, { immediate: true });
      watch(late, (is) => viewer.value.setDim(is ? DIM : 0), { immediate: true });
      watch(() => [shown.value, view.frame, view.playing], () => {
        clearTimeout(reader);
        reader = setTimeout(() => { said.value = view.playing ? "" : words(); }, QUIET);
      });
    };
    const words = () => {
      if (!shown.value) return t("shape.empty");
      const { title, size, notes: more } = summaryOf(shown.value.own);
      return [title, size, ...more.map(({ text }) => text), moment(view.frame)].join(", ");
    };
    const press = (part, event) => {
      container.value?.focus({ preventScroll: true });
      if (printing.value) return;
      const more = event.shiftKey || event.ctrlKey || event.metaKey;
      if (!part) {
        if (!more) select({});
        return;
      }
      const list = `${part.kind}s`;
      const { joints, beams } = state.selection;
      const before = { joints, beams }[list];
      const now = !more ? [part.number] : before.includes(part.number)
        ? before.filter((k) => k !== part.number) : [...before, part.number];
      select(more ? { joints, beams, [list]: now } : { [list]: now });
    };
    const onKeydown = (event) => {
      if (event.key === " " && event.target.matches(".shape-canvas, input[type=range]")) togglePlay();
      else if (event.target !== container.value || !viewer.value) return;
      else if (event.key === "5") view.parallel = !view.parallel;
      else if (!viewer.value.onKey(event)) return;
      event.preventDefault();
    };
    onMounted(() => {
      if (canDraw()) begin();
      else broken.value = "missing";
    });
    onBeforeUnmount(() => {
      clearTimeout(dimmer);
      clearTimeout(reader);
      triad?.dispose();
      viewer.value?.dispose();
      viewer.value = null;
    });
    const possible = (name) => hasValues(name, shown.value?.result, other.value);
    return () => h("section", {
      class: ["shape", { late: late.value }], "aria-label": t("shape.title"), onKeydown,
    }, [
      h("div", { class: ["shape-view", { broken: broken.value }] }, [
        h("div", {
          class: "shape-canvas", ref: container, tabindex: 0, role: "application",
          "aria-label": t("shape.canvas"), "aria-describedby": "shape-keys",
        }),
        h("p", { class: "hidden", id: "shape-keys" }, t("shape.keys")),
        h("p", { class: "hidden", role: "status", "aria-live": "polite" }, said.value),
        broken.value && h("div", { class: "shape-message", role: "alert" }, [
          h("strong", t(`shape.${broken.value}`)), h("p", t(`shape.${broken.value}Hint`)),
        ]),
        !broken.value && !shown.value && !printing.value && h("div", { class: "shape-message" }, [
          h("strong", t(state.busy ? "shape.computing" : "shape.empty")),
          state.busy ? preparing() && h("p", t("common.preparing")) : h("p", t("shape.emptyHint")),
        ]),
        !broken.value && !printing.value && h(Summary, {
          result: shown.value?.own ?? null, label: shown.value?.label ?? "", late: late.value,
          invalid: late.value && errors.value,
        }),
        !broken.value && (shown.value || printing.value) && h(Toolbar, {
          run: (name) => viewer.value.command(name), printing: printing.value,
        }),
        !broken.value && shown.value && !printing.value && h(Legend, {
          ...coloured.value, possible, distance: distance.value,
        }),
      ]),
      !printing.value && h(Playback, { snaps: shown.value?.result.snaps ?? [], disabled: !shown.value }),
    ]);
  },
};
