// What a result and a moment are called, in the language of the page.

import { view } from "../store.js";
import { formatNumber } from "../text/numbers.js";
import { t } from "../text/text.js";
import { momentOf } from "./timeline.js";
import { boundsOf, LAST } from "./topology.js";

/** Return a number as the language writes it. */
export const number = (value, digits = 1) => formatNumber(value, view.language, digits);

/** Return the words of a moment: "flat", "40 % released", "after creep". */
export function moment(frame) {
  const { key, values } = momentOf(frame);
  return t(`shape.${key}`, values);
}

/** Return what a result does in a few words: { title, size, near, notes: [{ kind, text }] }. */
export function summaryOf(result) {
  const { low, high } = boundsOf(result, LAST, LAST);
  const rise = result.rise_mm;
  const flat = Math.abs(rise) < 0.05; // mm, what would be written as 0
  const bound = result.bound_mm ?? null;
  const side = (axis) => number(high[axis] - low[axis], 0);
  const notes = [];
  if (!result.stable) notes.push({ kind: "warning", text: t("shape.unstable") });
  for (const { released } of result.snaps ?? [])
    notes.push({ kind: "warning", text: t("shape.snaps", { percent: number(100 * released, 0) }) });
  return {
    title: t(flat ? "shape.staysFlat" : rise > 0 ? "shape.rises" : "shape.falls", {
      mm: number(Math.abs(rise)),
    }),
    size: t("shape.size", { width: side(0), depth: side(1), height: side(2) }),
    near: bound === null ? "" : t("shape.bound", { mm: number(bound, bound < 0.1 ? 2 : 1) }),
    notes,
  };
}
