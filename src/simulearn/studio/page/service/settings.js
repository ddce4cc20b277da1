// What a visitor chose for this browser: theme, language, layout. Kept between visits.

import { watch, watchEffect } from "/libraries/vue.js";
import { view } from "../store.js";

const KEY = "simulearn.view";
const KEPT = ["theme", "language", "pane", "share", "side", "tip", "loop", "ghost", "heights", "dimensions"];
const small = globalThis.matchMedia("(max-width: 599px), (max-height: 559px)"); // phones, either way up
const dark = globalThis.matchMedia("(prefers-color-scheme: dark)");

/** Take over the settings of the last visit and keep them from now on. */
export function startSettings() {
  if (navigator.language?.startsWith("de")) view.language = "de";
  if (small.matches) view.side = false; // the views first
  const kept = read();
  for (const name of KEPT) {
    if (typeof kept[name] === typeof view[name]) view[name] = kept[name];
  }
  watchEffect(showTheme);
  dark.addEventListener("change", showTheme);
  watchEffect(() => {
    globalThis.document.documentElement.lang = view.language;
  });
  watch(() => KEPT.map((name) => view[name]), write);
}

function showTheme() {
  const theme = view.theme === "system" ? (dark.matches ? "dark" : "light") : view.theme;
  globalThis.document.documentElement.dataset.theme = theme;
}

function read() {
  try {
    return JSON.parse(localStorage.getItem(KEY)) ?? {};
  } catch {
    return {}; // a browser without storage, or a damaged entry: the settings begin anew
  }
}

function write() {
  try {
    localStorage.setItem(KEY, JSON.stringify(Object.fromEntries(KEPT.map((name) => [name, view[name]]))));
  } catch {
    // Settings are lost with the page; that the design is not kept either, `saving` says.
  }
}
