// The line that is being drawn, as a value: its corners and what is typed for the next one.

import { angle, distance } from "../../document/measure.js";
import { polar, samePoint } from "../geometry.js";

const LENGTH = /^\d{0,4}([.,]\d{0,3})?$/;
const ANGLE = /^-?\d{0,3}([.,]\d{0,2})?$/;

/** Return a line without corners. */
export function emptyLine() {
  return { points: [], length: "", angle: "", field: "length" };
}

/** Return the typed number, or null where there is none. */
export function typed(text) {
  const number = Number(text.replace(",", "."));
  return text === "" || !/\d/.test(text) || Number.isNaN(number) ? null : number;
}

/** Return whether something is typed for the next corner. */
export function isTyping(line) {
  return line.length !== "" || line.angle !== "";
}

/** Return the line after a typed character, or null where it does not belong to a number. */
export function type(line, character) {
  const next = line[line.field] + character;
  const fits = (line.field === "length" ? LENGTH : ANGLE).test(next);
  return fits && line.points.length ? { ...line, [line.field]: next } : null;
}

/** Return the line with the other field active. */
export function toggleField(line) {
  return { ...line, field: line.field === "length" ? "angle" : "length" };
}

/** Return the line without the last typed character, or without the last corner. */
export function backspace(line) {
  if (line[line.field] !== "") return { ...line, [line.field]: line[line.field].slice(0, -1) };
  if (isTyping(line)) return toggleField(line);
  return { ...line, points: line.points.slice(0, -1) };
}

/** Return where the next corner lies: the pointer's place, at the typed length and angle. */
export function target(line, point) {
  const from = line.points.at(-1);
  const length = typed(line.length);
  const degrees = typed(line.angle);
  if (!from || (length === null && degrees === null)) return point;
  const direction = degrees ?? (samePoint(from, point) ? 0 : angle(from, point));
  if (length !== null) return polar(from, length, direction);
  const [ux, uy] = polar([0, 0], 1, direction);
  const ahead = (point[0] - from[0]) * ux + (point[1] - from[1]) * uy;
  return polar(from, Math.max(0, ahead), direction);
}

/** Return {line, ended} after a corner at a point.
 *
 * The last corner once more (as by a double click) ends the line, the first one closes and ends it.
 */
export function place(line, point) {
  const { points } = line;
  if (points.length && samePoint(points.at(-1), point)) return { line, ended: points.length > 1 };
  const next = { ...emptyLine(), points: [...points, point] };
  return { line: next, ended: points.length > 1 && samePoint(points[0], point) };
}

/** Return the length and angle from the last corner to a point, or null before the first corner. */
export function measured(line, point) {
  const from = line.points.at(-1);
  return from ? { length: distance(from, point), angle: angle(from, point) } : null;
}
