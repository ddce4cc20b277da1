// Joints and beams in words, and which of them a message is about.

import { beamLength } from "../document/measure.js";
import { partsIn } from "../plan/messages.js";
import { select, state, view } from "../store.js";
import { formatNumber } from "../text/numbers.js";
import { t } from "../text/text.js";

const BOTH = new Set(["overlap", "joint-missing", "joints-coincide"]); // codes of messages whose text names both parts

/** Return the parts that a message is about: { joints, beams }. */
export function partsOf({ code, where = "", message = "" }, grid) {
  const found = { joints: [], beams: [] };
  for (const [part, number] of partsIn(BOTH.has(code) ? message : where)) {
    const [numbers, all] = part === "joint" ? [found.joints, grid.joints] : [found.beams, grid.beams];
    if (number < all.length && !numbers.includes(number)) numbers.push(number);
  }
  return found;
}

/** Return the messages of every part: { joints: Map, beams: Map } of lists of { kind, message }. */
export function messagesOfParts(check, grid) {
  const marks = { joints: new Map(), beams: new Map() };
  for (const [kind, messages] of [["error", check?.errors ?? []], ["warning", check?.warnings ?? []]]) {
    for (const message of messages) {
      const parts = partsOf(message, grid);
      for (const part of ["joints", "beams"]) {
        for (const number of parts[part]) {
          marks[part].set(number, [...(marks[part].get(number) ?? []), { kind, message: message.message }]);
        }
      }
    }
  }
  return marks;
}

/** Return a length or coordinate in mm as text. */
export function mm(value, digits = 1) {
  return formatNumber(value, view.language, digits);
}

/** Return what of a beam is actuated: "50 % top", "25 % bottom" or "passive". */
export function ratioWords(ratio) {
  if (!ratio) return t("common.passive");
  const percent = formatNumber(Math.abs(ratio) * 100, view.language, 0);
  return t(ratio > 0 ? "common.percentTop" : "common.percentBottom", { percent });
}

/** Return { name, detail } of a joint. */
export function jointWords(grid, k) {
  const [x, y] = grid.joints[k];
  const place = `${mm(x)}, ${mm(y)}`;
  return {
    name: t("common.joint", { k }),
    detail: k === grid.fixed ? `${t("common.fixed")} · ${place}` : place,
  };
}

/** Return { name, detail } of a beam. */
export function beamWords(grid, b) {
  return {
    name: t("common.beam", { b }),
    detail: `${mm(beamLength(grid, b))} mm · ${ratioWords(grid.actuators[b])}`,
  };
}

export function isSelected(kind, number) {
  return state.selection[kind].includes(number);
}

/** Add a part to the selection, or take it out. */
export function toggle(kind, number) {
  const numbers = state.selection[kind];
  select({
    ...state.selection,
    [kind]: isSelected(kind, number) ? numbers.filter((n) => n !== number) : [...numbers, number],
  });
}
