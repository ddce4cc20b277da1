// Which messages of the last check belong to which part of the plan.

import { sameTopology } from "./lengths.js";

const BOTH = new Set(["overlap", "joint-missing", "joints-coincide"]); // messages about two parts

/** Return {joints, beams}: maps from a number to {kind: "error" | "warning", messages: [string]}.
 *
 * Messages of an earlier grid count as long as its parts have the same numbers, so that marks do not
 * flicker during a drag.
 */
export function marksOf(check, grid) {
  const marks = { joints: new Map(), beams: new Map() };
  if (!check || !sameTopology(check.document.grid, grid)) return marks;
  const sorts = [["error", check.errors ?? []], ["warning", check.warnings ?? []]];
  for (const [kind, messages] of sorts)
    for (const { code, where, message } of messages)
      for (const [part, number] of partsIn(BOTH.has(code) ? message : where)) {
        const map = part === "joint" ? marks.joints : marks.beams;
        if (!map.has(number)) map.set(number, { kind, messages: [] });
        if (!map.get(number).messages.includes(message)) map.get(number).messages.push(message);
      }
  return marks;
}

/** Return the parts that a text names, as [["joint", 3], ["beam", 7]]. */
export function partsIn(text) {
  const found = [...String(text).matchAll(/\b(joint|beam) (\d+)/g)];
  return found.map(([, part, number]) => [part, Number(number)]);
}
