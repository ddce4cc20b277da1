// Where a pointer in the plan means to go: a joint, a beam, a direction, a line with other joints,
// a place of the grid of the plan.

import { angle as angleOf, between, crossing, distance, nearestOnSegment, rounded } from "./geometry.js";

const FAR = 1e4; // mm; a direction is drawn so far to find what it crosses
const EQUAL = 0.01; // mm; lengths closer than this are shown as one

/** Return the place that a point snaps to.
 *
 * document: whose joints and beams count, but for those of the joints in exclude (that are moved).
 * from: where the line that is drawn begins, or null. grid: mm between places of the plan, 0 for
 * none. radius: mm within which the pointer snaps. angle: degrees between directions, 0 for any.
 * lengths: whether lines snap to lengths.
 *
 * Returns {point, kind, joint?, beam?, t?, guides, text?}: kind is joint, crossing, beam, length,
 * angle, align, grid or none; t in [0, 1] is the place along the beam; guides are lines [[p, q]]
 * that say why; text says the length and direction from `from`.
 */
export function snap(point, options) {
  const { document, exclude = [], from = null, grid = 5, radius = 3, angle = 15, lengths = true } = options;
  const around = surroundings(document.grid, exclude);
  const setting = { point, from, grid, radius, angle, lengths, around };
  const rules = [toJoint, toBeam, toDirection, toLines, toGrid]; // the first that applies
  let found = null;
  for (const rule of rules) found ??= rule(setting);
  const text = from && distance(from, found.point) > 0 ? { text: measure(from, found.point) } : {};
  return { guides: [], ...found, ...text };
}

/** Return joints and beams that do not move: [{number, place}] and [{number, p, q}]. */
function surroundings({ joints, beams }, exclude) {
  const moves = new Set(exclude);
  return {
    joints: joints.map((place, number) => ({ number, place })).filter(({ number }) => !moves.has(number)),
    beams: beams
      .map(([i, j], number) => ({ number, i, j, p: joints[i], q: joints[j] }))
      .filter(({ i, j }) => !moves.has(i) && !moves.has(j)),
  };
}

function toJoint({ point, radius, around }) {
  const found = nearestEntry(around.joints, ({ place }) => distance(place, point), radius);
  return found && { point: [...found.place], kind: "joint", joint: found.number };
}

/** A beam: where a direction or line with a joint crosses it, its middle, or the nearest place. */
function toBeam(setting) {
  const { point, radius, around } = setting;
  const near = around.beams
    .map((beam) => ({ beam, ...nearestOnSegment(point, beam.p, beam.q) }))
    .filter((found) => found.distance <= radius)
    .sort((a, b) => a.distance - b.distance);
  if (near.length === 0) return null;
  const lines = near.slice(1, 3).map(({ beam }) => [beam.p, beam.q]); // two beams that cross
  const ray = direction(setting);
  if (ray) lines.push(ray);
  const { beam, t, point: place } = near[0];
  for (const line of lines) {
    const meet = crossing(beam.p, beam.q, ...line);
    if (meet && distance(meet, point) <= radius)
      return on(beam, meet, "crossing", line === ray ? [[setting.from, meet.map(rounded)]] : []);
  }
  const middle = between(beam.p, beam.q, 0.5);
  if (distance(middle, point) <= radius) return on(beam, middle, "beam");
  return t > 0 && t < 1 ? on(beam, place, "beam") : null;
}

function on({ number, p, q }, place, kind, guides = []) {
  return { point: place.map(rounded), kind, beam: number, t: nearestOnSegment(place, p, q).t, guides };
}

/** Return the line [from, far] in the direction near a point, or null where none is. */
function direction({ point, from, radius, angle }) {
  if (!from || !(angle > 0) || distance(from, point) <= 1e-9) return null;
  const degrees = Math.round(angleOf(from, point) / angle) * angle;
  const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
  const off = Math.abs((point[1] - from[1]) * c - (point[0] - from[0]) * s);
  return off <= radius ? [from, [from[0] + FAR * c, from[1] + FAR * s]] : null;
}

/** A direction, at a length or level with a joint where one is near. */
function toDirection(setting) {
  const { point, from, radius, around, lengths } = setting;
  const ray = direction(setting);
  if (!ray) return null;
  const at = (length) => between(from, ray[1], length / FAR).map(rounded);
  const [c, s] = [0, 1].map((axis) => (ray[1][axis] - from[axis]) / FAR);
  const along = (point[0] - from[0]) * c + (point[1] - from[1]) * s;
  const levels = around.joints.flatMap(({ place }) =>
    [[0, c], [1, s]].flatMap(([axis, slope]) => {
      const length = (place[axis] - from[axis]) / slope;
      // Along the line itself every place is level.
      return Math.abs(slope) > 1e-3 && length > radius ? [{ length, place }] : [];
    }));
  const level = nearestEntry(levels, ({ length }) => Math.abs(length - along), radius / 2);
  if (level) {
    const place = at(level.length);
    return { point: place, kind: "angle", guides: [[from, place], [level.place, place]] };
  }
  const length = lengths ? lengthNear(setting, along) : null;
  const place = at(length ?? Math.max(along, 0));
  return { point: place, kind: length === null ? "angle" : "length", guides: [[from, place]] };
}

/** Return a beam's length near a length, else the nearest multiple of the grid, or null. */
function lengthNear({ around, grid, radius }, along) {
  const beams = around.beams.map(({ p, q }) => distance(p, q)).filter((length) => length > radius);
  const beam = nearestEntry(beams, (length) => Math.abs(length - along), radius / 2);
  if (beam !== null) return beam;
  const step = grid > 0 ? Math.round(along / grid) * grid : 0;
  return step > 0 && Math.abs(step - along) <= Math.max(radius, grid / 2) ? step : null;
}

/** Level with other joints, in x, in y or both. */
function toLines({ point, around, radius, grid }) {
  const guides = [];
  const lines = [0, 1].map((axis) => {
    const other = 1 - axis;
    let best = null;
    for (const { place } of around.joints) {
      const off = Math.abs(place[axis] - point[axis]);
      const away = Math.abs(place[other] - point[other]);
      const better = !best || off < best.off - EQUAL || (off < best.off + EQUAL && away < best.away);
      if (off <= radius && better) best = { off, away, place };
    }
    return best;
  });
  if (!lines[0] && !lines[1]) return null;
  const place = lines.map((line, axis) => (line ? line.place[axis] : onGrid(point[axis], grid)));
  for (const line of lines) if (line) guides.push([line.place, place]);
  return { point: place, kind: "align", guides };
}

function toGrid({ point, grid }) {
  return { point: point.map((x) => onGrid(x, grid)), kind: grid > 0 ? "grid" : "none" };
}

function onGrid(x, grid) {
  return rounded(grid > 0 ? Math.round(x / grid) * grid : x);
}

/** Return the entry with the least distance, if that is within a limit; else null. */
function nearestEntry(entries, distanceOf, most) {
  let best = null;
  let least = most;
  for (const entry of entries) {
    const away = distanceOf(entry);
    if (away <= least && (best === null || away < least)) [best, least] = [entry, away];
  }
  return best;
}

function measure(from, to) {
  const [length, degrees] = [distance(from, to), angleOf(from, to)];
  return `${shown(length)} mm · ${shown(degrees)}°`;
}

function shown(x) {
  return String(Math.round(x * 10) / 10 + 0);
}
