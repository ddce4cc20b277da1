// What the panels say about a question to the server: hints, warnings, why there is no answer.

import { h, ref, watch } from "/libraries/vue.js";
import { t } from "../text/text.js";
import { icon } from "./icons.js";

const KNOWN = { offline: "panels.offline", "job-lost": "panels.jobLost" }; // codes of problems
const QUIET = 800; // ms without a change until a number is read out

/** Return a note: kind is "info", "warning" or "error"; an error is read out at once. */
export function note(kind, text, more = []) {
  return h("div", { class: ["callout", kind], role: kind === "error" ? "alert" : undefined }, [
    kind !== "info" && icon(kind, 18), h("div", [h("p", text), ...more]),
  ]);
}

/** Return a note about a Problem: what failed in the language of the page, then the server's reason. */
export function problemNote(title, problem) {
  const reason = reasonOf(problem);
  const others = (problem.errors ?? []).map(({ message }) => message).filter((text) => text !== reason);
  return note("error", title, [
    reason && h("p", reason),
    others.length > 0 && h("ul", others.slice(0, 5).map((text) => h("li", { key: text }, text))),
  ]);
}

/** Return why the server gave no answer, in a sentence. */
export function reasonOf(problem) {
  if (problem.status === 429) return t("panels.busy");
  return KNOWN[problem.code] ? t(KNOWN[problem.code]) : sentence(problem.message);
}

/** Return a message of the server as a sentence: with a capital and a full stop. */
export function sentence(text = "") {
  if (!text) return "";
  return `${text[0].toUpperCase()}${text.slice(1)}${/[.!?:]$/.test(text) ? "" : "."}`;
}

/** Return a list of messages with code and message. */
export function warnings(messages) {
  return messages.map(({ code, message }, k) => h("div", { key: `${code} ${k}`, class: "callout warning" }, [
    icon("warning", 18), h("div", [h("p", sentence(message))]),
  ]));
}

/** Return a component that reads out a text once it has not changed for a moment. */
export function Reader(text) {
  return {
    setup() {
      const read = ref("");
      let timer = 0;
      watch(text, (now) => {
        clearTimeout(timer);
        timer = setTimeout(() => { read.value = now; }, QUIET);
      });
      return () => h("p", { class: "hidden", role: "status" }, read.value);
    },
  };
}
