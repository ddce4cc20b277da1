// What can be done about an error or warning of the server's check, in one step.

import { beamLength, beamsAt } from "./measure.js";
import { distance, nearestOnSegment } from "./geometry.js";
import { mergeJoints, removeParts, scale, setActuators, setFixed } from "./edit.js";
import { withGrid } from "./document.js";
import { TOLERANCE, settle, splitBeam } from "./drawing.js";
import { nearestOf, piecesOf, rebuild } from "./numbering.js";
import { lasting, partsOf } from "./structure.js";
import { weave } from "./weaving.js";

const QUARTER = 0.25; // steps of a ratio
const ROUNDING = 1e-6; // mm, as in grid/checks.py
const WIDTH = 7.2; // mm, of a beam, unless limits say otherwise

const REPAIRS = {
  "actuator-short": lengthen,
  "joints-coincide": coincide,
  "joints-too-close": close,
  "joint-outline": untangle,
  overlap: join,
  "joint-missing": join,
  "fixed-removed": fixOther,
  disconnected: joinOrKeepLargest,
  "dangling-beam": joinOrRemove,
  "unused-joint": removeJoint,
  "counted-from-one": countFromZero,
  size: rescale,
};

/** Return a repair {label, values, apply(document)} of a message {code, where, message}, or null.
 *
 * label is a key for t(label, values). The document is the one that was checked; netLengths and
 * limits are those of its answer and material. apply gives the repaired document.
 */
export function repair(message, document, netLengths = {}, limits = {}) {
  const make = REPAIRS[message.code];
  const { number, parts } = named(message);
  const found = make?.({ message, document, netLengths, limits, number, parts }) ?? null;
  // Only what changes the document is offered.
  return found && found.apply(document) !== document ? { values: {}, ...found } : null;
}

/** Return a repair of all actuators that are too short, or null where fewer than two are. */
export function repairActuators(messages, document, netLengths = {}, limits = {}) {
  const short = messages.filter(({ code }) => code === "actuator-short");
  const found = short.map((message) => repair(message, document, netLengths, limits)).filter(Boolean);
  if (found.length < 2) return null;
  return {
    label: "repairs.setActuators",
    values: { count: found.length },
    apply: (one) => found.reduce((next, { apply }) => apply(next), one),
  };
}

/** Return the number in `where` and the parts {kind, number} that the message names. */
function named({ where = "", message = "" }) {
  const found = [...message.matchAll(/\b(joint|beam)s? (\d+)(?: and (\d+))?/g)];
  return {
    number: Number(/\d+/.exec(where)?.[0] ?? NaN),
    parts: found.flatMap(([, kind, ...numbers]) =>
      numbers.filter((n) => n !== undefined).map((n) => ({ kind, number: Number(n) }))),
  };
}

function lengthen({ document, netLengths, limits, number }) {
  const ratio = document.grid.actuators[number];
  const net = netLengths[number];
  if (!ratio) return null;
  const least = limits.actuator_length && net ? (limits.actuator_length - ROUNDING) / net : Infinity;
  const size = Math.ceil(least / QUARTER) * QUARTER;
  const next = size > 1 ? 0 : Math.sign(ratio) * size;
  return {
    label: next === 0 ? "repairs.clearActuator" : "repairs.setActuator",
    values: { beam: number, percent: Math.round(100 * next) },
    apply: (one) => setActuators(one, [number], next),
  };
}

function coincide({ parts }) {
  const [i, j] = new Set(parts.map(({ number }) => number));
  return i === undefined || j === undefined ? null : merge(i, j);
}

function close({ document, number, limits }) {
  const ends = document.grid.beams[number];
  // A beam of ordinary length is short of room for another reason: sharp corners at its ends.
  if (!ends || beamLength(document.grid, number) > 2 * (limits.width ?? WIDTH)) return null;
  return merge(...ends);
}

function merge(one, other) {
  const [i, j] = [Math.min(one, other), Math.max(one, other)];
  return { label: "repairs.merge", values: { a: i, b: j }, apply: (it) => mergeJoints(it, i, j) };
}

/** Beams that leave a joint in one direction run over each other: draw the way once. */
function untangle({ document, message, number, parts }) {
  if (/ lies where joint /.test(message.message)) {
    const joints = parts.filter(({ kind }) => kind === "joint").map((part) => part.number);
    return joints.length > 1 ? merge(joints[0], joints[1]) : null;
  }
  const two = parts.filter(({ kind }) => kind === "beam").map((part) => part.number);
  if (two.length !== 2 || !(number in document.grid.joints)) return null;
  return { label: "repairs.once", values: { a: two[0], b: two[1] }, apply: (one) => woven(one, two) };
}

function join({ document, parts, limits }) {
  if (parts.length < 2) return null;
  const { grid } = document;
  const width = limits.width ?? WIDTH;
  const [a, b] = parts;
  if (a.kind === "beam" && b.kind === "beam") {
    const two = [a.number, b.number];
    return { label: "repairs.joinBeams", values: { a: two[0], b: two[1] }, apply: (one) => woven(one, two) };
  }
  if (a.kind === "joint" && b.kind === "joint") {
    const apart = distance(grid.joints[a.number], grid.joints[b.number]);
    return apart < 2 * width ? merge(a.number, b.number) : null;
  }
  const [joint, beam] = a.kind === "joint" ? [a.number, b.number] : [b.number, a.number];
  return joinJoint(grid, joint, beam, width);
}

/** A joint that lies on a beam splits it; one at the beam's end is merged with that end. */
function joinJoint(grid, joint, beam, width) {
  const [i, j] = grid.beams[beam];
  if (joint === i || joint === j) return null;
  const found = nearestOnSegment(grid.joints[joint], grid.joints[i], grid.joints[j]);
  if (found.distance > width) return null;
  const end = [i, j].find((k) => distance(grid.joints[k], grid.joints[joint]) <= width);
  if (end !== undefined) return merge(end, joint);
  return {
    label: "repairs.joinJoint",
    values: { joint, beam },
    apply: (one) => mergeJoints(splitBeam(one, beam, found.t), joint, one.grid.joints.length),
  };
}

/** Return the document with joints where two beams cross, touch or begin to run over each other. */
function woven(document, [a, b]) {
  const { grid } = document;
  if (!(a in grid.beams) || !(b in grid.beams)) return document;
  const joints = [...grid.joints];
  const ends = new Set([...grid.beams[a], ...grid.beams[b]]);
  const two = piecesOf(grid).filter((_, n) => n === a || n === b);
  const cut = weave(joints, two, new Set([0, 1]), ends, TOLERANCE);
  const rest = piecesOf(grid).filter((_, n) => n !== a && n !== b);
  const first = cut.slice(0, 2);
  const all = [...rest, ...first].sort((one, other) => one.beam - other.beam);
  return rebuild(document, joints, [...all, ...cut.slice(2)], (k) => k);
}

function fixOther({ document }) {
  const { grid } = document;
  const stays = lasting(grid).joints;
  const k = nearestOf(grid.joints, grid.joints[grid.fixed], (n) => stays.has(n));
  return k === null ? null : { label: "repairs.fix", values: { joint: k }, apply: (one) => setFixed(one, k) };
}

/** Join the parts where they touch or cross; else keep the one with most beams, the fixed joint's of two. */
function joinOrKeepLargest({ document, limits }) {
  const { grid } = document;
  const part = partsOf(grid);
  const count = new Map();
  for (const [i] of grid.beams) count.set(part[i], (count.get(part[i]) ?? 0) + 1);
  const most = Math.max(...count.values());
  const own = part[grid.fixed];
  const stays = count.get(own) === most ? own : [...count.keys()].find((k) => count.get(k) === most);
  const beams = [...grid.beams.keys()].filter((b) => part[grid.beams[b][0]] !== stays);
  if (beams.length === 0) return null;
  const joints = [...new Set(beams.flatMap((b) => grid.beams[b]))];
  const join = touching(joints, limits);
  if (join(document) !== document) return { label: "repairs.joinParts", apply: join };
  return {
    label: "repairs.removeBeams",
    values: { count: beams.length },
    apply: (one) => removeParts(one, { beams }),
  };
}

/** Join a beam's loose ends to what they touch; else remove it. */
function joinOrRemove({ document, number, limits }) {
  const { grid } = document;
  if (!(number in grid.beams)) return null;
  const loose = grid.beams[number].filter((k) => beamsAt(grid, k).length === 1);
  const join = touching(loose, limits);
  const values = { beam: number };
  if (join(document) !== document) return { label: "repairs.joinBeam", values, apply: join };
  const beams = [number, ...hanging(grid, number)];
  const apply = (one) => removeParts(one, { beams });
  if (beams.length === 1) return { label: "repairs.removeBeam", values, apply };
  return { label: "repairs.removeDangling", values: { count: beams.length }, apply };
}

/** Return the dangling beams that would be a part of their own without beam b. */
function hanging(grid, b) {
  const stay = lasting(grid).beams;
  const part = partsOf({ ...grid, beams: grid.beams.filter((_, n) => n !== b) });
  const base = new Set([...stay].map((n) => part[grid.beams[n][0]]));
  const [i, j] = grid.beams[b];
  if (base.has(part[i]) === base.has(part[j])) return [];
  const loose = part[base.has(part[i]) ? j : i];
  return [...grid.beams.keys()].filter((n) => n !== b && part[grid.beams[n][0]] === loose);
}

/** Return the change that joins joints and their beams to all that they touch or cross. */
function touching(joints, { width = WIDTH }) {
  return (document) => settle(document, joints, width / 2);
}

function removeJoint({ number }) {
  const apply = (one) => removeParts(one, { joints: [number] });
  return { label: "repairs.removeJoint", values: { joint: number }, apply };
}

/** A file of another program may count its joints from 1; the joints stay, and what refers to them moves. */
function countFromZero() {
  const apply = (document) => {
    const { beams, fixed } = document.grid;
    if (fixed < 1 || beams.flat().includes(0)) return document;
    const grid = { ...document.grid, beams: beams.map((ends) => ends.map((k) => k - 1)), fixed: fixed - 1 };
    return withGrid(document, grid);
  };
  return { label: "repairs.countFromZero", apply };
}

/** A grid of another unit: the server says by which factor its beams are of usual lengths. */
function rescale({ message }) {
  const factor = Number(/multiply all coordinates by ([\d.e+-]+)/.exec(message.message)?.[1]);
  if (!(factor > 0)) return null;
  return { label: "repairs.scale", values: { factor: String(factor) }, apply: (one) => scale(one, factor) };
}
