// Icons of the shape's buttons, drawn in lines on 20 by 20.

import { h } from "/libraries/vue.js";

const PATHS = {
  fit: ["M3.5 7V3.5H7M13 3.5h3.5V7M16.5 13v3.5H13M7 16.5H3.5V13", "M7.5 7.5h5v5h-5z"],
  home: ["M10 2.8l6.3 3.6v7.2L10 17.2l-6.3-3.6V6.400z", "M3.7 6.400L10 10l6.3-3.600M10 10v7.2"],
  top: ["M10 3.200l6.3 3.500L10 10.2 3.7 6.700z", "M3.7 6.700v6.500L10 16.800l6.3-3.600V6.700M10 10.200v6.6"],
  front: ["M3.5 6.500h9v10h-9z", "M3.5 6.500l4-3h9v10l-4 3M12.5 6.500l4-3"],
  side: ["M7.5 3.500h9v10h-9z", "M7.5 3.500l-4 3v10h9l4-3M7.5 13.500l-4 3"],
  parallel: ["M3.5 6.500h10v10h-10z", "M6.5 6.500v-3h10v10h-3"],
  perspective: ["M3.5 6h10v10.500h-10z", "M3.5 6l6.5-2.500h6V10l-2.5 6.500M13.5 6L16 3.5"],
  display: ["M2.5 10c2-3.7 4.5-5.5 7.5-5.500s5.5 1.8 7.5 5.500c-2 3.7-4.5 5.5-7.5 5.500S4.5 13.7 2.5 10z", "M10 7.600a2.4 2.4 0 1 0 0 4.8 2.4 2.4 0 0 0 0-4.800z"],
  play: ["M6.5 4l9 6-9 6z"],
  pause: ["M7 4.500v11M13 4.500v11"],
  loop: ["M15.5 8.500A6 6 0 0 0 4.3 7.600M4.5 11.500a6 6 0 0 0 11.2.9", "M4.3 3.800v3.800h3.800M15.7 16.200v-3.800h-3.8"],
  check: ["M4 10.500l4 4 8-9"],
};

/** Return an icon as an <svg> that screen readers pass over. */
export function icon(name, size = 18) {
  return h("svg", { class: "shape-icon", viewBox: "0 0 20 20", width: size, height: size, "aria-hidden": "true" },
    PATHS[name].map((d) => h("path", { d })));
}
