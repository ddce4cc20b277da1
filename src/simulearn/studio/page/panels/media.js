// Media queries as values that a render function can depend on.

import { onBeforeUnmount, ref } from "/libraries/vue.js";

// The same conditions stand in style/layout.css.
export const PHONE = "(max-width: 599px)"; // one view at a time
export const NARROW = "(max-width: 599px), (max-width: 899px) and (min-height: 560px)"; // panel below

/** Return a ref that says whether the media query holds. */
export function useMedia(query) {
  const list = globalThis.matchMedia(query);
  const holds = ref(list.matches);
  const change = () => { holds.value = list.matches; };
  list.addEventListener("change", change);
  onBeforeUnmount(() => list.removeEventListener("change", change));
  return holds;
}
