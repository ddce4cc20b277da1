// What the browser's user has chosen: language, light or dark.

/** Return the language of the page: "de" where the browser's first one is German, else "en". */
export const language = () => (navigator.language?.startsWith("de") ? "de" : "en");

/** Show the page light or dark as the system is, now and whenever that changes. */
export function followTheme() {
  const dark = globalThis.matchMedia("(prefers-color-scheme: dark)");
  const show = () => {
    globalThis.document.documentElement.dataset.theme = dark.matches ? "dark" : "light";
  };
  dark.addEventListener("change", show);
  show();
}
