// The surface of a morphing grid as typed arrays, by the rule of simulate/skin.py: beams are strips
// around a ring of six points (the sides split at the mid-plane, for one half carries the actuator),
// joints are blocks. Laid out once for a grid, placed in the same arrays for every frame.

import { between, blend, topologyOf } from "./topology.js";

const SPACING = { few: 4, many: 6.5 }; // mm between stations along a beam, at most
const MANY = 100; // beams
const ROOM = 1.3; // of the storage over what is needed, so that small edits do not ask for new one

// Around a section, counter-clockwise seen against the beam's direction: right-bottom, left-bottom,
// left-middle, left-top, right-top, right-middle; each the mean of two of the four corners.
export const RING = [[0, 0], [1, 1], [1, 3], [3, 3], [2, 2], [0, 2]];
const UPPER = [false, false, true, true, true, false]; // half of the strip from ring point k to k + 1
const SHARP = [0, 1, 3, 4]; // ring points on edges of the printed body
const STRIPS = 6;
const ACROSS = 2 * STRIPS; // vertices of a station: the two of each strip, not shared across edges

/** What a vertex belongs to. */
export const TONE = { beam: 0, joint: 1, fixed: 2, top: 3, bottom: 4 };

/** Lay out the surface of a result.
 *
 * storage: that of an earlier skin, which is used again where it is large enough. Returns the skin:
 * storage { positions, normals, values, tones, marks, index, lines }, the counts that are in use,
 * `parts` (which vertices and triangles are whose) and `stations` along each beam.
 */
export function createSkin(result, grid, { spacing = null, storage = null } = {}) {
  const topology = topologyOf(result, grid);
  const fine = spacing ?? (topology.beams.length > MANY ? SPACING.many : SPACING.few);
  const beams = topology.beams.map((beam) => stationsOf(beam, fine));
  const vertexCount = sum(beams.map(({ t }) => t.length * ACROSS)) + sum(topology.joints.map(jointVertices));
  const indexCount = sum(beams.map(({ t, runs }) => (t.length - runs.length) * STRIPS * 6))
    + sum(topology.joints.map(({ free }) => 12 + 12 * free.length));
  const lineCount = sum(beams.map(({ t, runs }) => (t.length - runs.length) * SHARP.length * 2))
    + sum(topology.joints.map(({ free }) => 4 * free.length + 4 * verticals(free).length));
  const fits = storage && storage.tones.length >= vertexCount && storage.index.length >= indexCount
    && storage.lines.length >= lineCount;
  const skin = {
    topology, stations: beams, vertexCount, indexCount, lineCount, parts: [],
    storage: fits ? storage : allocate(vertexCount, indexCount, lineCount),
  };
  const at = { vertex: 0, index: 0, line: 0 };
  topology.beams.forEach((beam, b) => add(skin, at, "beam", b, beam.number, () => layBeam(skin, at, b)));
  topology.joints.forEach((joint, j) => add(skin, at, "joint", j, joint.number, () => layJoint(skin, at, j)));
  return skin;
}

/** Place the vertices and normals of a skin at a frame (0 to 11, fractions between two frames). */
export function placeSkin(skin, result, frame) {
  const moment = between(frame);
  for (const part of skin.parts) {
    if (part.kind === "beam") placeBeam(skin, result, part, moment);
    else placeJoint(skin, result, part, moment);
  }
  return skin;
}

/** Return {low, high} of the vertices in use. */
export function skinBounds({ storage: { positions }, vertexCount }) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k < 3 * vertexCount; k += 1) {
    low[k % 3] = Math.min(low[k % 3], positions[k]);
    high[k % 3] = Math.max(high[k % 3], positions[k]);
  }
  return { low, high };
}

/** Return the volume inside the surface, mm3 (divergence theorem over its triangles). */
export function skinVolume({ storage: { positions: p, index }, indexCount }) {
  let six = 0;
  for (let k = 0; k < indexCount; k += 3) {
    const [a, b, c] = [3 * index[k], 3 * index[k + 1], 3 * index[k + 2]];
    six += p[a] * (p[b + 1] * p[c + 2] - p[b + 2] * p[c + 1])
      + p[a + 1] * (p[b + 2] * p[c] - p[b] * p[c + 2])
      + p[a + 2] * (p[b] * p[c + 1] - p[b + 1] * p[c]);
  }
  return six / 6;
}

const sum = (numbers) => numbers.reduce((total, n) => total + n, 0);
const jointVertices = ({ free }) => 8 + 6 * free.length;

/** Return the free sides k whose next side is free too: a vertical edge is seen between them. */
const verticals = (free) => free.filter((k) => free.includes((k + 1) % 4));

function allocate(vertexCount, indexCount, lineCount) {
  const room = (n) => Math.ceil(n * ROOM);
  return {
    positions: new Float32Array(3 * room(vertexCount)),
    normals: new Float32Array(3 * room(vertexCount)),
    values: new Float32Array(room(vertexCount)), // what is coloured: stress, strain, height, ...
    tones: new Uint8Array(room(vertexCount)),
    marks: new Uint8Array(room(vertexCount)), // 0 plain, 128 under the pointer, 255 selected
    index: new Uint32Array(room(indexCount)),
    lines: new Uint32Array(room(lineCount)),
  };
}

/** Return the stations of a beam: t from 0 to 1, in runs that end at the middle and where the actuator
 * ends, with the weights of the three sections for place and tangent. */
function stationsOf({ ratio, length }, spacing) {
  const reach = Math.abs(ratio) / 2;
  const stops = [...new Set([0, 0.5 - reach, 0.5, 0.5 + reach, 1])].sort((a, b) => a - b);
  const runs = [];
  const t = [];
  for (let k = 0; k + 1 < stops.length; k += 1) {
    const [from, to] = [stops[k], stops[k + 1]];
    const steps = Math.max(1, Math.ceil(((to - from) * length) / spacing));
    runs.push({ first: t.length, steps, active: reach > 0 && Math.abs((from + to) / 2 - 0.5) < reach });
    for (let n = 0; n <= steps; n += 1) t.push(from + ((to - from) * n) / steps);
  }
  const place = new Float64Array(3 * t.length);
  const slope = new Float64Array(3 * t.length);
  t.forEach((x, k) => {
    place.set([2 * (x - 0.5) * (x - 1), 4 * x * (1 - x), 2 * x * (x - 0.5)], 3 * k);
    slope.set([4 * x - 3, 4 - 8 * x, 4 * x - 1], 3 * k);
  });
  return { t, runs, place, slope };
}

function add(skin, at, kind, position, number, lay) {
  const part = { kind, at: position, number, firstVertex: at.vertex, firstIndex: at.index };
  lay();
  part.vertexCount = at.vertex - part.firstVertex;
  part.indexCount = at.index - part.firstIndex;
  skin.parts.push(part);
}

function quad(skin, at, a, b, c, d) {
  skin.storage.index.set([a, b, c, a, c, d], at.index);
  at.index += 6;
}

function line(skin, at, a, b) {
  skin.storage.lines[at.line] = a;
  skin.storage.lines[at.line + 1] = b;
  at.line += 2;
}

function layBeam(skin, at, b) {
  const { runs, t } = skin.stations[b];
  const { ratio } = skin.topology.beams[b];
  const { tones } = skin.storage;
  for (const { first, steps, active } of runs) {
    for (let k = 0; k < STRIPS; k += 1) {
      const printed = active && UPPER[k] === ratio > 0;
      const tone = printed ? (ratio > 0 ? TONE.top : TONE.bottom) : TONE.beam;
      for (let n = 0; n <= steps; n += 1) {
        const a = at.vertex + (first + n) * ACROSS + 2 * k;
        tones[a] = tone;
        tones[a + 1] = tone;
        if (n === steps) continue;
        quad(skin, at, a, a + 1, a + 1 + ACROSS, a + ACROSS);
        if (SHARP.includes(k)) line(skin, at, a, a + ACROSS);
      }
    }
  }
  at.vertex += t.length * ACROSS;
}

function layJoint(skin, at, j) {
  const { fixed, free } = skin.topology.joints[j];
  const first = at.vertex; // top 0 to 3, bottom 1 0 3 2, then bottom, middle, top of each free side
  quad(skin, at, first, first + 1, first + 2, first + 3);
  quad(skin, at, first + 4, first + 5, first + 6, first + 7);
  const side = (k) => first + 8 + 6 * free.indexOf(k);
  for (const k of free) {
    const v = side(k);
    quad(skin, at, v, v + 1, v + 3, v + 2);
    quad(skin, at, v + 2, v + 3, v + 5, v + 4);
    line(skin, at, v, v + 1);
    line(skin, at, v + 4, v + 5);
  }
  for (const k of verticals(free)) {
    const v = side(k);
    line(skin, at, v + 1, v + 3);
    line(skin, at, v + 3, v + 5);
  }
  at.vertex += jointVertices(skin.topology.joints[j]);
  skin.storage.tones.fill(fixed ? TONE.fixed : TONE.joint, first, at.vertex);
}

const corners = new Float64Array(36); // of the part that is placed
const here = new Float64Array(18); // the six ring points of a station
const along = new Float64Array(18); // the tangents there

function placeBeam(skin, result, { at, firstVertex }, moment) {
  const { positions, normals } = skin.storage;
  const { t, place, slope } = skin.stations[at];
  blend(result.beams, result.beamCount * 36, at * 36, 36, moment, corners);
  for (let n = 0; n < t.length; n += 1) {
    ringAt(corners, place, n, here);
    ringAt(corners, slope, n, along);
    let v = 3 * (firstVertex + n * ACROSS);
    for (let k = 0; k < STRIPS; k += 1) {
      const a = 3 * k;
      const b = k === STRIPS - 1 ? 0 : a + 3;
      const [x, y, z] = [here[b] - here[a], here[b + 1] - here[a + 1], here[b + 2] - here[a + 2]];
      for (let end = 0; end < 2; end += 1) {
        const r = end ? b : a;
        positions[v] = here[r];
        positions[v + 1] = here[r + 1];
        positions[v + 2] = here[r + 2];
        const nx = y * along[r + 2] - z * along[r + 1];
        const ny = z * along[r] - x * along[r + 2];
        const nz = x * along[r + 1] - y * along[r];
        const scale = 1 / (Math.sqrt(nx * nx + ny * ny + nz * nz) || 1);
        normals[v] = nx * scale;
        normals[v + 1] = ny * scale;
        normals[v + 2] = nz * scale;
        v += 3;
      }
    }
  }
}

/** Write the six ring points at station n, of corners (3 sections, 4, 3) by weights (n, 3). */
export function ringAt(numbers, weights, n, into) {
  const [u, v, w] = [weights[3 * n], weights[3 * n + 1], weights[3 * n + 2]];
  for (let axis = 0; axis < 3; axis += 1) {
    const a = u * numbers[axis] + v * numbers[axis + 12] + w * numbers[axis + 24];
    const b = u * numbers[axis + 3] + v * numbers[axis + 15] + w * numbers[axis + 27];
    const c = u * numbers[axis + 6] + v * numbers[axis + 18] + w * numbers[axis + 30];
    const d = u * numbers[axis + 9] + v * numbers[axis + 21] + w * numbers[axis + 33];
    into[axis] = a;
    into[axis + 3] = b;
    into[axis + 6] = (b + d) / 2;
    into[axis + 9] = d;
    into[axis + 12] = c;
    into[axis + 15] = (a + c) / 2;
  }
}

/** Return the corner numbers (bottom 0 to 3, top 4 to 7; pairs are means) of a joint's vertices. */
export function jointCorners(free) {
  const list = [[4, 4], [5, 5], [6, 6], [7, 7], [1, 1], [0, 0], [3, 3], [2, 2]];
  for (const k of free) {
    const next = (k + 1) % 4;
    list.push([k, k], [next, next], [k, k + 4], [next, next + 4], [k + 4, k + 4], [next + 4, next + 4]);
  }
  return list;
}

function placeJoint(skin, result, { at, firstVertex }, moment) {
  const { positions, normals } = skin.storage;
  blend(result.joints, result.jointCount * 24, at * 24, 24, moment, corners);
  const { free } = skin.topology.joints[at];
  const list = jointCorners(free);
  list.forEach(([a, b], n) => {
    for (let axis = 0; axis < 3; axis += 1)
      positions[3 * (firstVertex + n) + axis] = (corners[3 * a + axis] + corners[3 * b + axis]) / 2;
  });
  facet(positions, normals, firstVertex, [0, 1, 2, 3], 4);
  facet(positions, normals, firstVertex + 4, [0, 1, 2, 3], 4);
  free.forEach((_, n) => facet(positions, normals, firstVertex + 8 + 6 * n, [0, 1, 5, 4], 6));
}

/** Give `count` vertices the normal of the quadrilateral of four of them (by its diagonals). */
function facet(positions, normals, first, [a, b, c, d], count) {
  const p = (k, axis) => positions[3 * (first + k) + axis];
  const [ux, uy, uz] = [p(c, 0) - p(a, 0), p(c, 1) - p(a, 1), p(c, 2) - p(a, 2)];
  const [vx, vy, vz] = [p(d, 0) - p(b, 0), p(d, 1) - p(b, 1), p(d, 2) - p(b, 2)];
  const normal = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
  const scale = 1 / (Math.hypot(...normal) || 1);
  for (let n = 0; n < count; n += 1)
    for (let axis = 0; axis < 3; axis += 1) normals[3 * (first + n) + axis] = normal[axis] * scale;
}
