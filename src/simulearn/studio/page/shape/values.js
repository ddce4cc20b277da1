// What a shape is coloured by: one number for each vertex of its skin, and the range over all frames.

import { boundsOf, between, blend, FRAMES } from "./topology.js";
import { jointCorners, RING, ringAt } from "./skin.js";

const ACROSS = 12; // vertices of a station
const corners = new Float64Array(36);
const flat = new Float64Array(36);
const ring = new Float64Array(18);

/** Return whether a result has what it would be coloured by; `reference` is the result to compare with. */
export function hasValues(by, result, reference = null) {
  if (by === "stress") return Boolean(result?.mises);
  if (by === "deviation") return comparable(result, reference);
  return true;
}

/** Return whether two results are of the same parts, so that vertices correspond. */
export function comparable(a, b) {
  return Boolean(a && b) && a.jointCount === b.jointCount && a.beamCount === b.beamCount;
}

/** Write the values of a frame into the skin's storage; joints have none by stress and strain. */
export function fillValues(skin, result, by, frame, reference = null) {
  const fill = { stress: fillStress, strain: fillStrain, height: fillHeight, deviation: fillDeviation }[by];
  fill?.(skin, result, between(frame), reference);
}

/** Return [least, most] over all frames, in the unit of `by` (MPa, %, mm). */
export function rangeOf(by, result, reference = null) {
  if (by === "stress") return [0, mostOf(result.mises)];
  if (by === "strain") return strainRange(result);
  if (by === "deviation") return [0, deviationRange(result, reference)];
  const { low, high } = boundsOf(result);
  return [low[2], high[2]];
}

function eachBeam(skin, visit) {
  for (const part of skin.parts) if (part.kind === "beam") visit(part, skin.stations[part.at]);
}

/** Write value(k) of the six ring points k to the twelve vertices of a station. */
function spread(values, vertex, value) {
  for (let k = 0; k < 6; k += 1) {
    values[vertex + 2 * k] = value[k];
    values[vertex + 2 * k + 1] = value[(k + 1) % 6];
  }
}

const ofRing = new Float64Array(6);

function fillStress(skin, result, moment) {
  const { values } = skin.storage;
  eachBeam(skin, ({ at, firstVertex }, { t, runs }) => {
    blend(result.mises, result.beamCount * 16, at * 16, 16, moment, corners);
    for (const { first, steps } of runs) {
      const late = t[first] >= 0.5 ? 2 : 0; // sections of the half: start and before, after and end
      for (let n = first; n <= first + steps; n += 1) {
        const along = 2 * t[n] - (late ? 1 : 0);
        RING.forEach(([a, b], k) => {
          const from = (corners[4 * late + a] + corners[4 * late + b]) / 2;
          const to = (corners[4 * late + 4 + a] + corners[4 * late + 4 + b]) / 2;
          ofRing[k] = from + along * (to - from);
        });
        spread(values, firstVertex + n * ACROSS, ofRing);
      }
    }
  });
}

/** How much longer the long edges are than in the flat frame, in per cent: from the start to the middle
 * and from there to the end, as the sections say no more about where along a beam they stretch. */
function fillStrain(skin, result, moment) {
  const { values } = skin.storage;
  const size = result.beamCount * 36;
  eachBeam(skin, ({ at, firstVertex }, { t, runs }) => {
    blend(result.beams, size, at * 36, 36, moment, corners);
    blend(result.beams, size, at * 36, 36, { before: 0, after: 0, t: 0 }, flat);
    const halves = [stretches(0), stretches(1)];
    for (const { first, steps } of runs)
      for (let n = first; n <= first + steps; n += 1)
        spread(values, firstVertex + n * ACROSS, halves[t[first] >= 0.5 ? 1 : 0]);
  });
}

/** Return the stretch of the six ring points' lines in a half of a beam; those of the mid-plane are the
 * means of the edges beside them. */
function stretches(half) {
  const edges = [0, 1, 2, 3].map((edge) => 100 * (arc(corners, edge, half) / arc(flat, edge, half) - 1));
  return RING.map(([a, b]) => (edges[a] + edges[b]) / 2);
}

// Gauss's rule of three points on [0, 1]: exact enough for the length of a smooth arc
const GAUSS = [[0.5 - Math.sqrt(0.15), 5 / 18], [0.5, 8 / 18], [0.5 + Math.sqrt(0.15), 5 / 18]];

/** Return the length of an edge's parabola in a half of a beam (times a constant). */
function arc(sections, edge, half) {
  let length = 0;
  for (const [place, weight] of GAUSS) {
    const t = (half + place) / 2;
    let square = 0;
    for (let axis = 0; axis < 3; axis += 1) {
      const k = 3 * edge + axis;
      const [a, b, c] = [sections[k], sections[k + 12], sections[k + 24]];
      square += ((4 * t - 3) * a + (4 - 8 * t) * b + (4 * t - 1) * c) ** 2;
    }
    length += weight * Math.sqrt(square);
  }
  return length;
}

function strainRange(result) {
  const size = result.beamCount * 36;
  let most = 0;
  for (let frame = 1; frame < FRAMES; frame += 1) {
    for (let b = 0; b < result.beamCount; b += 1) {
      blend(result.beams, size, b * 36, 36, { before: frame, after: frame, t: 0 }, corners);
      blend(result.beams, size, b * 36, 36, { before: 0, after: 0, t: 0 }, flat);
      for (const value of [...stretches(0), ...stretches(1)]) most = Math.max(most, Math.abs(value));
    }
  }
  return [-most, most];
}

function fillHeight({ storage: { positions, values }, vertexCount }) {
  for (let v = 0; v < vertexCount; v += 1) values[v] = positions[3 * v + 2];
}

/** The distance of each vertex from the same vertex of the other result, mm. */
function fillDeviation(skin, result, moment, reference) {
  const { values } = skin.storage;
  for (const { kind, at, firstVertex } of skin.parts) {
    const [name, size, count] = kind === "beam"
      ? ["beams", 36, result.beamCount] : ["joints", 24, result.jointCount];
    blend(result[name], count * size, at * size, size, moment, corners);
    blend(reference[name], count * size, at * size, size, moment, flat);
    for (let k = 0; k < size; k += 1) corners[k] -= flat[k];
    if (kind === "beam") {
      const { t, place } = skin.stations[at];
      for (let n = 0; n < t.length; n += 1) {
        ringAt(corners, place, n, ring);
        for (let k = 0; k < 6; k += 1) ofRing[k] = Math.hypot(ring[3 * k], ring[3 * k + 1], ring[3 * k + 2]);
        spread(values, firstVertex + n * ACROSS, ofRing);
      }
    } else {
      jointCorners(skin.topology.joints[at].free).forEach(([a, b], n) => {
        values[firstVertex + n] = Math.hypot(
          ...[0, 1, 2].map((axis) => (corners[3 * a + axis] + corners[3 * b + axis]) / 2),
        );
      });
    }
  }
}

function deviationRange(result, reference) {
  let most = 0;
  for (const name of ["joints", "beams"]) {
    const [a, b] = [result[name], reference[name]];
    for (let k = 0; k < a.length; k += 3)
      most = Math.max(most, Math.hypot(a[k] - b[k], a[k + 1] - b[k + 1], a[k + 2] - b[k + 2]));
  }
  return most;
}

function mostOf(numbers) {
  let most = 0;
  for (const value of numbers) if (value > most) most = value;
  return most;
}
