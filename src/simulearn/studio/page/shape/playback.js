// The timeline: from flat to morphed by a slider, or playing.

import { h, onBeforeUnmount, watch } from "/libraries/vue.js";
import { view } from "../store.js";
import { t } from "../text/text.js";
import { icon } from "./icons.js";
import { advance, clockAt, nextFrame, snapFrame } from "./timeline.js";
import { LAST } from "./topology.js";
import { moment } from "./words.js";

/** Start or stop playing. */
export function togglePlay() {
  view.playing = !view.playing;
}

export const Playback = {
  props: { snaps: Array, disabled: Boolean },
  setup(props) {
    let [clock, last, request] = [0, 0, 0];
    const step = (now) => {
      request = 0;
      if (!view.playing) return;
      const next = advance(clock, Math.min(0.1, (now - last) / 1000), view.loop);
      last = now;
      clock = next.clock;
      view.frame = next.frame;
      view.playing = next.playing;
      if (view.playing) request = requestAnimationFrame(step);
    };
    watch(() => view.playing && !props.disabled, (on) => {
      cancelAnimationFrame(request);
      if (!on) return;
      clock = clockAt(view.frame);
      last = performance.now();
      request = requestAnimationFrame(step);
    });
    onBeforeUnmount(() => {
      cancelAnimationFrame(request);
      view.playing = false;
    });
    const show = (frame) => {
      view.playing = false;
      view.frame = frame;
    };
    const onKeydown = (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const delta = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
      if (delta) show(nextFrame(view.frame, delta));
      else if (event.key === "Home") show(0);
      else if (event.key === "End") show(LAST);
      else return;
      event.preventDefault();
    };
    // While playing, words change with the frames: new ones for every drawing could not be read, and in
    // software to paint them takes longer than the shape.
    const words = () => moment(view.playing ? Math.floor(view.frame) : view.frame);
    return () => h("div", { class: "shape-timeline" }, [
      h("button", {
        type: "button", class: "shape-button play", disabled: props.disabled,
        "aria-label": t(view.playing ? "shape.pause" : "shape.play"),
        title: `${t(view.playing ? "shape.pause" : "shape.play")} (${t("shape.space")})`, onClick: togglePlay,
      }, icon(view.playing ? "pause" : "play")),
      h("button", {
        type: "button", class: "shape-button", "aria-label": t("shape.loop"), title: t("shape.loop"),
        "aria-pressed": view.loop, onClick: () => { view.loop = !view.loop; },
      }, icon("loop")),
      h("div", { class: "shape-slider" }, [
        h("input", {
          type: "range", min: 0, max: LAST, step: 0.01, value: view.frame, disabled: props.disabled,
          "aria-label": t("shape.moment"), "aria-valuetext": words(),
          onInput: (event) => show(snapFrame(Number(event.target.value))),
          onKeydown,
        }),
        // What is seen of the slider moves without being painted anew, which playing would wait for.
        h("div", { class: "shape-track", "aria-hidden": "true" }, [
          h("div", { class: "done", style: { transform: `scaleX(${view.frame / LAST})` } }),
        ]),
        h("div", {
          class: "shape-thumb", "aria-hidden": "true",
          style: { transform: `translateX(${(100 * view.frame) / LAST}%)` },
        }),
        h("div", { class: "shape-marks", "aria-hidden": "true" }, [
          ...Array.from({ length: LAST + 1 }, (_, k) => mark(k, k === 0 || k >= LAST - 1 ? "strong" : "")),
          ...(props.snaps ?? []).map(({ released, frame }) =>
            mark(frame === LAST ? LAST - 0.5 : 10 * released, "snap", t("shape.snapsHere"))),
        ]),
      ]),
      h("output", { class: "shape-moment" }, props.disabled ? "" : words()),
    ]);
  },
};

const mark = (frame, kind, title) => h("i", {
  key: `${kind}${frame}`, class: kind, title, style: { left: `${(100 * frame) / LAST}%` },
});
