// Vertices of goals, and changes of designs, in the words of the page.

import { mm, ratio } from "../service/format.js";
import { view } from "../store.js";
import { formatNumber } from "../text/numbers.js";
import { t } from "../text/text.js";

const ARROWS = ["→", "↗", "↑", "↖", "←", "↙", "↓", "↘"]; // eighths of a turn from +x

/** Return a vertex in words: "Joint 3, centre". */
export function vertexWords([part, number, ...rest]) {
  if (part === "joint") {
    const [corner] = rest;
    return corner === "centre" ? t("panels.jointCentre", { k: number })
      : t("panels.jointCorner", { k: number, corner });
  }
  const [section, corner] = rest;
  const values = { b: number, section: t(`panels.${section}`), corner };
  return t(corner === "centre" ? "panels.beamCentre" : "panels.beamCorner", values);
}

function moveWords({ k, by: [dx, dy] }) {
  const eighth = (Math.round(Math.atan2(dy, dx) / (Math.PI / 4)) + 8) % 8;
  const length = formatNumber(Math.hypot(dx, dy), view.language, 1);
  return t("panels.moveJoint", { k, arrow: ARROWS[eighth], mm: `${length} mm` });
}

/** Return the changes of a design in words: "Actuator 3: 0 % → +25 %". */
export function changeWords({ joints, actuators }) {
  const words = [
    ...joints.map(moveWords),
    ...actuators.map(({ b, from, to }) => t("panels.changeRatio", { b, from: ratio(from), to: ratio(to) })),
  ];
  if (words.length < 2) return words[0] ?? t("panels.same");
  return t("panels.andMore", { first: words[0], n: words.length - 1 });
}

/** Return how much closer a design comes: "4.2 mm closer". */
export function gainWords(gain) {
  if (Math.abs(gain) < 0.005) return t("panels.same");
  return t(gain > 0 ? "panels.closer" : "panels.farther", { mm: mm(Math.abs(gain)) });
}
