// The page's icons: strokes on a square of 20 units, in the colour of the text around them.

import { h } from "/libraries/vue.js";

const PATHS = {
  undo: "M7.5 4 4 7.5 7.5 11M4 7.5h7.5a4.5 4.5 0 0 1 0 9H8",
  redo: "M12.5 4 16 7.5 12.5 11M16 7.5H8.5a4.5 4.5 0 0 0 0 9H12",
  library: "M3 3.5h5.5V9H3zM11.5 3.5H17V9h-5.5zM3 11.5h5.5V17H3zM11.5 11.5H17V17h-5.5z",
  file: "M5 2.5h6.5L15.5 6.5v11H5zM11.5 2.5v4h4",
  settings: "M3 6h8M15 6h2M3 14h2M9 14h8M11 4v4M15 4v4M11 6h0M5 12v4M9 12v4M11 4h4v4h-4zM5 12h4v4H5z",
  help: "M7.2 7.4a2.8 2.8 0 1 1 4.3 2.3c-1 .7-1.5 1.2-1.5 2.3M10 15v.1",
  chevron: "M5.5 8l4.5 4.5L14.5 8",
  close: "M5 5l10 10M15 5 5 15",
  plus: "M10 4v12M4 10h12",
  minus: "M4 10h12",
  trash: "M3.5 5.5h13M8 5.5V3.5h4v2M5.5 5.5l.7 11h7.6l.7-11M8.5 8.5v5M11.5 8.5v5",
  split: "M3 10h4.5M12.5 10H17M10 4.5v2M10 13.5v2M10 8a2 2 0 1 0 0 4 2 2 0 0 0 0-4z",
  mirrorX: "M10 3v2M10 7v2M10 11v2M10 15v2M7.5 5.5 2.5 14.5h5zM12.5 5.5l5 9h-5z",
  mirrorY: "M3 10h2M7 10h2M11 10h2M15 10h2M14.5 7.5l-9-5v5zM14.5 12.5l-9 5v-5z",
  rotate: "M15.5 6.5A6.5 6.5 0 1 0 16.5 10M16 3v4h-4",
  pin: "M7 3h6M8 3v5l-2.5 3h9L12 8V3M10 11v6",
  joint: "M10 6.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7zM10 2.5v4M10 13.5v4M2.5 10h4M13.5 10h4",
  beam: "M4.5 13a2 2 0 1 0 0 4 2 2 0 0 0 0-4zM15.5 3a2 2 0 1 0 0 4 2 2 0 0 0 0-4zM6 13.5 14 6.5",
  plan: "M3.5 3.5h13v13h-13zM3.5 10h13M10 3.5v13",
  shape: "M2.5 12.5c4-8.5 11-8.5 15 0M2.5 12.5c4-3.5 11-3.5 15 0M10 6.200v3.7",
  both: "M3 4h14v12H3zM10 4v12",
  side: "M3 4h14v12H3zM12.5 4v12",
  error: "M10 2.5a7.5 7.5 0 1 0 0 15 7.5 7.5 0 0 0 0-15zM10 6v5M10 13.800v.1",
  warning: "M10 3 2.5 16.5h15zM10 8v4M10 14.200v.1",
  check: "M4 10.5l4 4 8-9",
  link: "M8.5 11.5a3 3 0 0 0 4.3 0l3-3a3 3 0 0 0-4.3-4.3l-1 1"
    + "M11.5 8.5a3 3 0 0 0-4.3 0l-3 3a3 3 0 0 0 4.3 4.3l1-1",
  download: "M10 3v9.5M6 9l4 4 4-4M3.5 16.5h13",
  open: "M3 16V4.5h5l1.5 2H17V16z",
  scale: "M11.5 3.5h5v5M16.5 3.5 11 9M8.5 16.5h-5v-5M3.5 16.5 9 11",
  hand: "M10 3v8M6.5 6.5 10 3l3.5 3.5M4 13v3.5h12V13",
  target: "M10 4a6 6 0 1 0 0 12 6 6 0 0 0 0-12zM10 1.5v5M10 13.5v5M1.5 10h5M13.5 10h5",
  surface: "M2.5 13c3-6 5-6 7.5-3s4.5 3 7.5-3M2.5 13c3 2 5 3 7.5 3s4.5-1 7.5-3M17.5 7v6",
  clock: "M10 2.5a7.5 7.5 0 1 0 0 15 7.5 7.5 0 0 0 0-15zM10 6v4.5l3 1.5",
};

/** Return an icon, hidden from assistive technology: the control around it has the name. */
export function icon(name, size = 20) {
  return h("svg", {
    class: "icon", width: size, height: size, viewBox: "0 0 20 20", fill: "none", stroke: "currentColor",
    "stroke-width": 1.5, "stroke-linecap": "round", "stroke-linejoin": "round",
    "aria-hidden": "true", focusable: "false",
  }, [h("path", { d: PATHS[name] })]);
}
