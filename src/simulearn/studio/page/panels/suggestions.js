// Suggestions as cards: looked at with the pointer or the focus on them, taken with a click or Enter.

import { h, onBeforeUnmount, watch } from "/libraries/vue.js";
import { withDesign } from "../service/designs.js";
import { mm } from "../service/format.js";
import { endPreview, showPreview } from "../service/preview.js";
import {
  askSuggestions, drawSuggestions, dropSuggestions, freshSuggestions,
} from "../service/suggestions.js";
import { takeDesign } from "../service/taking.js";
import { notify, state, undo, view } from "../store.js";
import { t } from "../text/text.js";
import { rove } from "./controls.js";
import { icon } from "./icons.js";
import { note, problemNote } from "./notes.js";
import { changeWords, gainWords } from "./vertices.js";

const NEAR = 0.1; // mm, about the model's own error: a design that comes so near is there
const PICTURE = { width: 88, height: 56 }; // pixels

function take(card) {
  const words = changeWords(card.changes);
  endPreview(card.grid);
  takeDesign(state.document, card, t("panels.didSuggestion", { words }));
  notify(t("panels.tookSuggestion", { words }), { label: t("panels.undo"), run: undo });
}

function card(one, k, error, fresh) {
  const words = changeWords(one.changes);
  const gain = error - one.error;
  const show = () => {
    if (!fresh || state.preview?.result === one.result) return;
    showPreview(one.grid, {
      result: one.result, label: words, document: withDesign(state.document, state.document, one.grid),
    });
  };
  const hide = () => endPreview(one.grid);
  return h("li", { key: k }, [ // by its place, so that the focus stays where it is
    h("button", {
      type: "button", class: "suggestion", "aria-disabled": fresh ? undefined : "true",
      "aria-label": t("panels.cardName", { words, mm: mm(one.error), gain: gainWords(gain) }),
      // Not on entering: a new card that appears under a resting pointer is not looked at yet.
      onPointermove: show, onPointerleave: hide, onFocus: show, onBlur: hide,
      onClick: () => fresh && take(one),
    }, [
      h("span", { class: "suggestion-picture" }, one.picture
        ? [h("img", { src: one.picture, alt: "", ...PICTURE })] : [icon("shape", 24)]),
      h("span", { class: "suggestion-text" }, [
        h("span", { class: "suggestion-words" }, words),
        h("span", { class: "suggestion-facts numbers" }, [
          h("strong", mm(one.error)),
          h("span", { class: gain > 0 ? "better" : "worse" }, gainWords(gain)),
        ]),
      ]),
    ]),
  ]);
}

export const Suggestions = {
  setup() {
    watch([
      () => state.document.grid, () => state.document.goals, () => state.document.surfaces,
      () => state.document.pose, () => state.answer,
    ], askSuggestions, { immediate: true });
    watch(() => view.theme, drawSuggestions, { flush: "post" });
    onBeforeUnmount(() => {
      dropSuggestions();
      for (const { grid } of state.suggestions?.cards ?? []) endPreview(grid);
    });
    const onKeydown = (event) => {
      rove(event, [...event.currentTarget.querySelectorAll("button")]);
    };
    const content = () => {
      const { suggestions } = state;
      if (!suggestions) return h("p", { class: "note", role: "status" }, t("panels.suggesting"));
      const { cards, error, problem } = suggestions;
      if (problem) return problemNote(t("panels.suggestionsFailed"), problem);
      const fresh = freshSuggestions();
      if (error < NEAR && fresh) return h("p", { class: "note" }, t("panels.arrived"));
      if (cards.length === 0) return note("info", t("panels.suggestionsNone"));
      return [
        !fresh ? h("p", { class: "note" }, t("panels.suggestionsOld"))
          : cards[0].error >= error ? h("p", { class: "note" }, t("panels.suggestionsWorse"))
            : h("p", { class: "note" }, t("panels.suggestionsNote")),
        h("ol", { class: ["suggestions", { old: !fresh }], "aria-label": t("panels.suggestions"), onKeydown },
          cards.map((one, k) => card(one, k, error, fresh))),
      ];
    };
    return () => h("section", { class: "part-section", "aria-label": t("panels.suggestions") }, [
      h("h2", t("panels.suggestions")), content(),
    ]);
  },
};
