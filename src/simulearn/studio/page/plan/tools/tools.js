// The tools of the plan by name. Each answers to the pointer (hover, press, drag, release, leave), to
// keys (true where a key was used) and can be cancelled.

import { state } from "../../store.js";
import { draw } from "./draw.js";
import { fix } from "./fix.js";
import { selectTool } from "./select.js";
import { split } from "./split.js";

export const TOOLS = { select: selectTool, draw, split, fix };

/** Return the tool in use. */
export function currentTool() {
  return TOOLS[state.tool] ?? TOOLS.select;
}
