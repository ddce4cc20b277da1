// The colours of the view, read from the style sheet's variables.

import { parseColour } from "./colours.js";

const NAMES = {
  canvas: "--canvas", line: "--line", lineStrong: "--line-strong", text: "--text", textSoft: "--text-soft",
  accent: "--accent", beam: "--beam", joint: "--joint", top: "--actuator-top", bottom: "--actuator-bottom",
  target: "--target", error: "--error", surface: "--surface", brim: "--brim",
};

/** Return {canvas: [r, g, b], ...} as they are at an element; `dark` says whether the canvas is. */
export function readTheme(element = globalThis.document.documentElement) {
  const style = globalThis.getComputedStyle(element);
  const theme = Object.fromEntries(
    Object.entries(NAMES).map(([name, variable]) => [name, parseColour(style.getPropertyValue(variable))]),
  );
  const [r, g, b] = theme.canvas;
  theme.dark = 0.2126 * r + 0.7152 * g + 0.0722 * b < 0.5;
  return theme;
}

/** Call back when the theme changes, by the page or by the system; return a function that ends it. */
export function watchTheme(callback) {
  const root = globalThis.document.documentElement;
  const observer = new MutationObserver(callback);
  observer.observe(root, { attributes: true, attributeFilter: ["data-theme", "class", "style"] });
  const system = globalThis.matchMedia("(prefers-color-scheme: dark)");
  system.addEventListener("change", callback);
  return () => {
    observer.disconnect();
    system.removeEventListener("change", callback);
  };
}
