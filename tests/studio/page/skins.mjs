// Measures the page's surface of results: {spacing, frames, messages: [base64]} on stdin, for each
// frame {low, high, volume, vector, areas by tone, flat: cosine of normals to triangles} on stdout.

import { readFileSync } from "node:fs";
import { parseFrames } from "../../../src/simulearn/studio/page/service/frames.js";
import {
  createSkin, placeSkin, skinBounds, skinVolume,
} from "../../../src/simulearn/studio/page/shape/skin.js";

const { spacing, frames, message, grid } = JSON.parse(readFileSync(0, "utf8"));
const bytes = Buffer.from(message, "base64");
const [result] = parseFrames(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const skin = createSkin(result, grid, { spacing });

function measures(frame) {
  placeSkin(skin, result, frame);
  const { positions, normals, index, tones } = skin.storage;
  const areas = [0, 0, 0, 0, 0];
  const vector = [0, 0, 0];
  let facing = 1;
  const at = (array, v) => [0, 1, 2].map((axis) => array[3 * v + axis]);
  for (let k = 0; k < skin.indexCount; k += 3) {
    const [a, b, c] = [0, 1, 2].map((n) => at(positions, index[k + n]));
    const [u, v] = [b.map((x, n) => x - a[n]), c.map((x, n) => x - a[n])];
    const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const area = Math.hypot(...cross) / 2;
    areas[tones[index[k]]] += area;
    cross.forEach((x, n) => { vector[n] += x / 2; });
    for (let n = 0; n < 3; n += 1) {
      const normal = at(normals, index[k + n]);
      facing = Math.min(facing, cross.reduce((sum, x, m) => sum + x * normal[m], 0) / (2 * area));
    }
  }
  return { ...skinBounds(skin), volume: skinVolume(skin), vector, areas, facing };
}

process.stdout.write(JSON.stringify(frames.map(measures)));
