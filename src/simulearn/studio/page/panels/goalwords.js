// Goals in the words of the page: whose they are and what is wanted.

import { ITSELF, kindOf } from "../document/kinds.js";
import { mm, number } from "../service/format.js";
import { t } from "../text/text.js";
import { vertexWords } from "./vertices.js";

const place = (point) => point.map((x) => number(x, Number.isInteger(x) ? 0 : 1)).join(", ");

/** Return which points a goal is about: "All joints", "Joint 3, centre", "4 points". */
export function whoseWords({ vertex, vertices }) {
  if (vertices === "joints") return t("surface.allJoints");
  if (vertices === "beams") return t("surface.allBeams");
  const points = vertices ?? [vertex];
  return points.length === 1 ? vertexWords(points[0]) : t("surface.chosen", { n: points.length });
}

function faceWords([part, k, ...rest]) {
  if (part === "joint")
    return t(rest[0] === "top" ? "surface.top" : "surface.side", { k, side: rest[0] });
  const [section, top] = rest;
  if (!section) return t("surface.course", { b: k });
  return t(top ? "surface.sectionTop" : "surface.section", { b: k, section: t(`panels.${section}`) });
}

const WORDS = {
  target: (goal) => (goal.vertex ? vertexWords(goal.vertex)
    : t("surface.target", { whose: whoseWords(goal), place: place(goal.target) })),
  surface: (goal) => t("surface.on", { whose: whoseWords(goal), name: goal.surface }),
  curve: (goal) => t("surface.curve", { whose: whoseWords(goal) }),
  plane: (goal) => t("surface.plane", { whose: whoseWords(goal) }),
  direction: ({ face, faces = [face], direction }) => t("surface.direction", {
    whose: faces.length === 1 ? faceWords(faces[0]) : t("surface.faces", { n: faces.length }),
    place: place(direction),
  }),
  distance: ({ vertices: [a, b], distance }) => t("surface.distance", {
    a: vertexWords(a), b: vertexWords(b), mm: mm(distance),
  }),
  angle: ({ faces: [a, b], angle }) => t("surface.angle", {
    a: faceWords(a), b: faceWords(b), degrees: number(angle),
  }),
  away_from: ({ away_from: body, clearance = 0 }) => t("surface.away", {
    body: body === ITSELF ? t("surface.itself") : body, mm: mm(clearance),
  }),
};

/** Return what a goal wants: "All joints on hood". */
export function goalWords(goal) {
  return WORDS[kindOf(goal)](goal);
}

/** Return what else is said of a goal, as of one that cannot be changed here. */
export function goalDetails({ slide = true, tolerance, weight }) {
  return [
    !slide && t("surface.fixedPoints"), tolerance !== undefined && t("surface.within", { mm: mm(tolerance) }),
    weight !== 1 && t("surface.weight", { weight: number(weight, Number.isInteger(weight) ? 0 : 2) }),
  ].filter(Boolean).join(", ");
}
