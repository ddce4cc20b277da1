// Several designs that a search answers with: each is shown in the scene and taken by its button.

import { h, onBeforeUnmount } from "/libraries/vue.js";
import { clock, mm, number, percent } from "../service/format.js";
import { hideStage, showStage } from "../service/search.js";
import { state } from "../store.js";
import { t } from "../text/text.js";
import { rove } from "./controls.js";
import { takeStage } from "./found.js";

/** Return what an answer takes, in words. */
function takes({ actuators, length, seconds, within }) {
  return [
    t("panels.answerActuators", { n: actuators, mm: `${number(length)} mm` }),
    seconds !== null && t("panels.answerPrint", { time: clock(seconds) }),
    within !== null && t("panels.answerWithin", { percent: percent(within) }),
  ].filter(Boolean).join(", ");
}

function row(one, k) {
  const name = t("panels.answerName", { n: k + 1, mm: mm(one.error), takes: takes(one) });
  const show = () => showStage(one, t("panels.answerLabel", { n: k + 1 }));
  return h("li", { key: k }, [
    h("button", {
      type: "button", class: ["suggestion", "answer"], "aria-label": name,
      onPointermove: show, onPointerleave: hideStage, onFocus: show, onBlur: hideStage,
      onClick: () => takeStage(one),
    }, [
      h("span", { class: "suggestion-text" }, [
        h("span", { class: "suggestion-words numbers" }, [
          h("strong", `${k + 1}  ${mm(one.error)}`),
          !one.byFea && ` ${t("panels.answerByModel")}`,
        ]),
        h("span", { class: "suggestion-facts numbers" }, takes(one)),
        one.collides && h("span", { class: "suggestion-facts" }, t("panels.answerCollides")),
        one.beaten && !one.collides && h("span", { class: "suggestion-facts" }, t("panels.answerBeaten")),
      ]),
    ]),
  ]);
}

/** The answers as a list of buttons. */
export const Answers = {
  setup() {
    onBeforeUnmount(hideStage);
    const onKeydown = (event) => rove(event, [...event.currentTarget.querySelectorAll("button")]);
    return () => h("div", { class: "answers" }, [
      h("h3", t("panels.answers")),
      h("p", { class: "note" }, t("panels.answersChoose")),
      h("ol", { class: "suggestions", "aria-label": t("panels.answers"), onKeydown },
        state.search.answers.map((one, k) => row(one, k))),
    ]);
  },
};
