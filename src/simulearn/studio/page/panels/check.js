// The tab "Check": the shape by finite elements beside the model's, and how far apart they are.

import { computed, h, onBeforeUnmount } from "/libraries/vue.js";
import { cancelCheck, checking, startCheck } from "../service/checking.js";
import { clock, mm, percent, seconds, times } from "../service/format.js";
import { deviation } from "../shape/deviation.js";
import { stale, state, view } from "../store.js";
import { t } from "../text/text.js";
import { button } from "./controls.js";
import { facts } from "./fields.js";
import { note, problemNote, Reader, sentence } from "./notes.js";
import { Spread } from "./spread.js";

const FRAMES = 11; // that are computed: the flat one is given
export const NOT_LEARNT = "material-not-learnt"; // code of the error that finite elements do not mind
const RELEASED = 10; // frames in which it is released, a tenth each

/** Return { mean, max, part } of the last frame: the mean distance, the largest one and where it is. */
function apart({ reference, result }) {
  const found = reference && result && deviation(reference, result, FRAMES);
  if (!found) return null;
  const at = found.distances.indexOf(Math.max(...found.distances));
  const joints = 8 * reference.jointCount;
  const part = at < joints
    ? { key: "joint", values: { k: reference.joint_numbers[Math.floor(at / 8)] } }
    : { key: "beam", values: { b: reference.beam_numbers[Math.floor((at - joints) / 12)] } };
  return { mean: found.mean, max: found.max, part };
}


function snapWords(snaps) {
  if (!snaps?.length) return t("panels.snapsNone");
  return snaps.map(({ released, frame }) => frame > RELEASED ? t("panels.snapsCreeping")
    : t("panels.snapsAt", { percent: percent(released ?? frame / RELEASED) })).join(", ");
}

function progress({ progress: frames, seconds: passed, state: now, lost }) {
  const [done, total] = frames ?? [0, FRAMES];
  return h("div", { class: "search-running" }, [
    h("div", {
      class: ["progress", { waiting: !frames }], role: "progressbar", "aria-label": t("panels.check"),
      "aria-valuemin": 0, "aria-valuemax": total, "aria-valuenow": frames ? done : undefined,
    }, [h("span", { style: { width: `${(100 * done) / total}%` } })]),
    h("p", { class: "search-facts numbers" }, [
      h("span", now === "queued" ? t("panels.checkQueued") : t("panels.checkFrames", { done, total })),
      h("span", clock(passed)),
    ]),
    now === "running" && h("p", { class: "note" }, t("panels.checkRunning")),
    lost && note("warning", t("panels.lost")),
    button(t("panels.checkCancel"), cancelCheck),
  ]);
}

function toggle(label, on, set, disabled = false) {
  return h("label", { class: "checkbox" }, [
    h("input", {
      type: "checkbox", role: "switch", checked: on, disabled, onChange: (event) => set(event.target.checked),
    }), label,
  ]);
}

function outcome(fea, distance, current) {
  const { reference, result } = fea;
  const bound = reference?.bound_mm ?? null;
  const quick = reference?.seconds;
  const slow = result.seconds ?? fea.seconds;
  const inside = distance && bound !== null ? distance.mean <= bound : null;
  return [
    !reference ? note("info", t("panels.checkAlone")) : distance
      ? h("div", { class: "measure" }, [
        h("p", { class: "measure-value numbers" }, [
          mm(distance.mean),
          inside !== null && h("span", { class: ["verdict", inside ? "better" : "worse"] },
            t(inside ? "panels.inBound" : "panels.outOfBound")),
        ]),
        h("p", { class: "measure-name" }, t("panels.meanApart")),
      ])
      : note("warning", t("panels.notComparable")),
    facts([
      distance && [t("panels.largestApart"), t("panels.atPart", {
        mm: mm(distance.max), part: t(`panels.${distance.part.key}`, distance.part.values),
      })],
      bound !== null && [t("panels.bound"), mm(bound)],
      [t("panels.stable"), t(result.stable ? "panels.yes" : "panels.no")],
      [t("panels.snaps"), snapWords(result.snaps)],
      quick && [t("panels.timeModel"), seconds(quick)],
      [t("panels.timeFea"), seconds(slow)],
    ]),
    quick && slow > quick && h("p", { class: "note" },
      t("panels.faster", { times: times(slow / quick) })),
    result.stable === false && note("warning", t("panels.notStable")),
    current && reference && h("div", { class: "toggles" }, [ // only a shape of the present design is drawn over it
      toggle(t("panels.overlay"), view.overlay, (on) => { view.overlay = on; }),
      toggle(t("panels.colourDeviation"), view.colour === "deviation", (on) => {
        view.colour = on ? "deviation" : "actuator";
      }, !distance),
    ]),
    result.remarks?.length > 0 && h("section", { "aria-label": t("panels.remarks") }, [
      h("h3", t("panels.remarks")),
      h("ul", { class: "plain" }, result.remarks.map((text) => h("li", { key: text }, sentence(text)))),
    ]),
  ];
}

export const Check = {
  setup() {
    const distance = computed(() => (state.fea?.state === "done" ? apart(state.fea) : null));
    const Read = Reader(() => (
      distance.value ? t("panels.checkDone", { mm: mm(distance.value.mean) }) : ""
    ));
    onBeforeUnmount(() => {
      if (view.colour === "deviation") view.colour = "actuator"; // other tabs do not show the other shape
    });
    return () => {
      const { fea } = state;
      const current = fea?.document.grid === state.document.grid;
      const ready = state.answer && !stale.value;
      const errors = state.check?.errors ?? [];
      // Finite elements take any material; the model may have learnt others.
      const alone = errors.length === 1 && errors[0].code === NOT_LEARNT
        && state.check.document.grid === state.document.grid;
      return h("div", { class: "panel" }, [
        h("section", { class: "part-section", "aria-label": t("panels.check") }, [
          !fea && h("p", { class: "note" }, t("panels.checkNote")),
          !checking() && h("div", { class: "row" }, [
            button(t(fea ? "panels.checkAgain" : "panels.checkStart"), startCheck, {
              kind: fea?.state === "done" && current ? "" : "primary", disabled: !ready && !alone,
            }),
          ]),
          errors.length > 0 && !alone && !checking() && h("p", { class: "note" }, t("panels.checkNeedsShape")),
          fea && !current && note("warning", t("panels.checkEarlier")),
          checking() && progress(fea),
          fea?.state === "done" && outcome(fea, distance.value, current),
          fea?.state === "cancelled" && note("info", t("panels.checkCancelled")),
          fea?.state === "failed" && (fea.problem ? problemNote(t("panels.checkFailed"), fea.problem)
            : note("error", t("panels.checkFailed"), [
              h("p", sentence(fea.message)), fea.hint && h("p", sentence(fea.hint)),
            ])),
          h(Read),
        ]),
        h(Spread),
      ]);
    };
  },
};
