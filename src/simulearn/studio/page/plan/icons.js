// Icons of the plan's buttons, drawn in lines on 20 by 20.

import { h } from "/libraries/vue.js";

const PATHS = {
  select: ["M5 3.5l10.5 6-4.8 1.4-2.3 4.6z"],
  draw: [
    "M4.5 15.5L15.5 6", "M4.5 13.7a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6z",
    "M15.5 2.7a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6z",
  ],
  split: [
    "M2.5 10h4.7M12.8 10h4.7M10 2.5v2.6M10 14.9v2.6",
    "M10 7.6a2.4 2.4 0 1 0 0 4.8 2.4 2.4 0 0 0 0-4.8z",
  ],
  fix: [
    "M10 5.8V17M6.8 8.6h6.4M3.8 11.5c.3 3.2 2.8 5.3 6.2 5.5 3.4-.2 5.9-2.3 6.2-5.5",
    "M10 2.4a1.7 1.7 0 1 0 0 3.4 1.7 1.7 0 0 0 0-3.4z",
  ],
  delete: ["M3.5 5.5h13M8 5.5V3.5h4v2M5 5.5l.8 11h8.4l.8-11M8.3 8.5v5M11.7 8.5v5"],
  duplicate: ["M7 7h9.5v9.5H7z", "M13 7V3.5H3.5V13H7"],
  mirrorX: ["M10 2.5v15", "M7.5 5.5v9H2.5zM12.5 5.5v9h5z"],
  mirrorY: ["M2.5 10h15", "M5.5 7.5h9V2.5zM5.5 12.5h9v5z"],
  rotate: ["M15.8 10.5a5.9 5.9 0 1 1-2-4.9L16 7.5", "M16 3.5v4h-4"],
  fit: ["M3.5 7V3.5H7M13 3.5h3.5V7M16.5 13v3.5H13M7 16.5H3.5V13", "M7.5 7.5h5v5h-5z"],
  plus: ["M10 4.5v11M4.5 10h11"],
  minus: ["M4.5 10h11"],
  flip: ["M6.5 16.5v-13M3.5 6.5l3-3 3 3M13.5 3.5v13M10.5 13.5l3 3 3-3"],
  none: ["M10 3.5a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13zM5.5 14.5l9-9"],
  done: ["M4 10.5l4 4 8-9"],
  close: ["M5 5l10 10M15 5L5 15"],
};

/** Return an icon as an <svg> that screen readers pass over. */
export function icon(name, size = 18) {
  return h(
    "svg", { class: "plan-icon", viewBox: "0 0 20 20", width: size, height: size, "aria-hidden": "true" },
    PATHS[name].map((d) => h("path", { d })),
  );
}
