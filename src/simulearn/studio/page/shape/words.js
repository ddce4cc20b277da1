// What a result and a moment are called, in the language of the page.

import { view } from "../store.js";
import { formatNumber } from "../text/numbers.js";
import { t } from "../text/text.js";
import { momentOf } from "./timeline.js";
import { boundsOf, LAST } from "./topology.js";

const NAMED = 3; // collisions that are named

/** Return a number as the language writes it. */
export const number = (value, digits = 1) => formatNumber(value, view.language, digits);

/** Return the words of a moment: "flat", "40 % released", "after creep". */
export function moment(frame) {
  const { key, values } = momentOf(frame);
  return t(`shape.${key}`, values);
}

/** Return { kind, number } of a part such as "beam 3" of a result, as the drawing numbers it. */
export function partOf(result, part) {
  const [kind, number] = part.split(" ");
  return { kind, number: result[`${kind}_numbers`]?.[number] ?? Number(number), index: Number(number) };
}

function partName(result, part) {
  const { kind, number: k } = partOf(result, part);
  return t(`shape.part-${kind}`, { number: k });
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
  for (const { released, frame } of result.snaps ?? []) {
    const text = frame === LAST ? t("shape.snapsCreeping") : t("shape.snaps", { percent: number(100 * released, 0) });
    notes.push({ kind: "warning", text });
  }
  for (const { parts, frame, share, depth_mm: mm } of (result.collisions ?? []).slice(0, NAMED)) {
    const [a, b] = parts.map((part) => partName(result, part));
    const when = moment(share < 0.5 ? frame : frame + 1);
    const text = t("shape.collide", { a, b, when, mm: number(mm) });
    notes.push({ kind: "warning", text: text[0].toUpperCase() + text.slice(1) });
  }
  const more = (result.collisions?.length ?? 0) - NAMED;
  if (more > 0) notes.push({ kind: "warning", text: t("shape.moreCollide", { count: more }) });
  return {
    title: t(flat ? "shape.staysFlat" : rise > 0 ? "shape.rises" : "shape.falls", {
      mm: number(Math.abs(rise)),
    }),
    size: t("shape.size", { width: side(0), depth: side(1), height: side(2) }),
    near: bound === null ? "" : t("shape.bound", { mm: number(bound, bound < 0.1 ? 2 : 1) }),
    notes,
  };
}
