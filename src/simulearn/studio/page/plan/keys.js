// The keys of the plan. `command` says which command a key stands for; `listenKeys` runs it where the
// key is meant for the plan and not for a field, a menu or another part of the page.

const PLAIN = {
  v: "select", d: "draw", s: "split", x: "fix", f: "fit", "+": "longer", "=": "longer", "-": "shorter",
  0: "quarters 0", 1: "quarters 1", 2: "quarters 2", 3: "quarters 3", 4: "quarters 4", b: "flip",
  m: "mirror x", r: "rotate 90",
  delete: "delete", backspace: "delete",
};
const SHIFTED = { m: "mirror y", r: "rotate -90", "+": "longer", "*": "longer", f10: "menu" };
const CONTROL = { z: "undo", y: "redo", a: "all", c: "copy", v: "paste", d: "duplicate" };
const FIELDS = [
  "input", "textarea", "select", "[contenteditable='']", "[contenteditable=true]", "dialog", "[role=dialog]",
  "[role=menu]",
].join();
// Buttons outside the plan that have keys of their own.
const GROUPS = ["[role=tablist]", "[role=radiogroup]", "[role=listbox]", ".shape"].join();

/** Return the command of a key event, or null. */
export function command({ key, ctrlKey, metaKey, shiftKey, altKey }) {
  const name = key.toLowerCase();
  if (name === "contextmenu") return "menu";
  if (ctrlKey || metaKey) {
    if (altKey) return null;
    if (name === "z" && shiftKey) return "redo";
    if (name.startsWith("arrow")) return "focus";
    return shiftKey ? null : CONTROL[name] ?? null;
  }
  if (name.startsWith("arrow")) return "arrow";
  if (altKey) return null;
  return (shiftKey ? SHIFTED[name] : PLAIN[name]) ?? null;
}

/** Return how far an arrow key moves joints: 1 mm, with shift 10, with alt 0.1. */
export function nudgeStep({ shiftKey, altKey }) {
  if (altKey) return 0.1;
  return shiftKey ? 10 : 1;
}

/** Return whether a key pressed at an element is meant for something else than the plan.
 *
 * A button that was clicked keeps the focus; keys that it has no use for go to the plan.
 */
export function isElsewhere(target, plan) {
  if (target.closest?.(FIELDS)) return true;
  if (target === document.body || target === document.documentElement || plan.contains(target)) return false;
  return !target.closest?.("button") || target.closest(GROUPS) !== null;
}

/** Listen to keys that are meant for `plan`; returns a function that ends this.
 *
 * react(event): whether the key was used; then nothing else sees it.
 */
export function listenKeys(plan, react) {
  const pressed = (event) => {
    if (event.defaultPrevented || event.isComposing || isElsewhere(event.target, plan)) return;
    if (!react(event)) return;
    event.preventDefault();
    event.stopPropagation();
  };
  document.addEventListener("keydown", pressed);
  return () => document.removeEventListener("keydown", pressed);
}
