// Icons of the shape's buttons, drawn in lines on 20 by 20.

import { h } from "/libraries/vue.js";

const TOP = "M10 2.8l6.2 3.6L10 10 3.8 6.4z"; // the faces of a cube
const LEFT = "M3.8 6.4L10 10v7.2l-6.2-3.6z";
const RIGHT = "M16.2 6.4L10 10v7.2l6.2-3.6z";
const FILLED = ["top", "front", "side"]; // icons whose first path is filled

const PATHS = {
  fit: ["M3.5 7V3.5H7M13 3.5h3.5V7M16.5 13v3.5H13M7 16.5H3.5V13", "M7.5 7.5h5v5h-5z"],
  home: [TOP, LEFT, RIGHT],
  top: [TOP, LEFT, RIGHT],
  front: [LEFT, TOP, RIGHT],
  side: [RIGHT, TOP, LEFT],
  parallel: ["M3.5 6.5h10v10h-10z", "M6.5 6.5v-3h10v10h-3"],
  perspective: ["M3.5 6h10v10.5h-10z", "M3.5 6l6.5-2.5h6V10l-2.5 6.5M13.5 6L16 3.5"],
  display: [
    "M2.5 10c2-3.7 4.5-5.5 7.5-5.5s5.5 1.8 7.5 5.5c-2 3.7-4.5 5.5-7.5 5.5S4.5 13.7 2.5 10z",
    "M10 7.6a2.4 2.4 0 1 0 0 4.8 2.4 2.4 0 0 0 0-4.8z",
  ],
  play: ["M6.5 4l9 6-9 6z"],
  pause: ["M7 4.5v11M13 4.5v11"],
  loop: [
    "M15.5 8.5A6 6 0 0 0 4.3 7.6M4.5 11.5a6 6 0 0 0 11.2.9",
    "M4.3 3.8v3.8h3.8M15.7 16.2v-3.8h-3.8",
  ],
};

/** Return an icon as an <svg> that screen readers pass over. */
export function icon(name, size = 18) {
  return h(
    "svg", { class: "shape-icon", viewBox: "0 0 20 20", width: size, height: size, "aria-hidden": "true" },
    PATHS[name].map((d, k) => h("path", { d, class: { filled: k === 0 && FILLED.includes(name) } })),
  );
}
