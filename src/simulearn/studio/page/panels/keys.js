// Keys that work everywhere on the page: undo, redo, files, help.

import { chooseFile, saveFile } from "../service/files.js";
import { redo, state, undo } from "../store.js";

/** Listen to the page's keys. */
export function startKeys() {
  globalThis.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || state.dialog || !state.started) return;
    const typing = event.target.closest?.("input:not([type=range]), textarea, select");
    const run = shortcut(event, typing);
    if (!run) return;
    event.preventDefault();
    run();
  });
}

function shortcut(event, typing) {
  const control = event.ctrlKey || event.metaKey;
  const key = event.key.toLowerCase();
  if (!control) return event.key === "?" && !typing ? () => { state.dialog = { name: "help" }; } : null;
  if (event.altKey) return null;
  if (key === "s" && !event.shiftKey) return () => saveFile();
  if (key === "o" && !event.shiftKey) return chooseFile;
  if (typing) return null; // a field has an undo of its own
  if (key === "z") return event.shiftKey ? redo : undo;
  if (key === "y") return redo;
  return null;
}
