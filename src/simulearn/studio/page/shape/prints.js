// The axes of the beams in many prints of one design, as thin lines around its shape.

import { THREE } from "/libraries/three.js";
import { plain } from "./material.js";

const PIECES = 8; // of an axis
const FAINT = 0.22; // so that many lines over one another are darker than one

/** Return the ends of short lines along the axes through (T, B, 3, 3) centres, mm. */
export function axesOf(centres) {
  const points = new Float32Array((centres.length / 9) * PIECES * 6);
  let at = 0;
  for (let n = 0; n < centres.length; n += 9) {
    for (let k = 0; k < PIECES; k += 1) {
      for (const u of [k / PIECES, (k + 1) / PIECES]) {
        // The parabola through start, middle and end.
        const weights = [(1 - u) * (1 - 2 * u), 4 * u * (1 - u), u * (2 * u - 1)];
        for (let axis = 0; axis < 3; axis += 1) {
          points[at] = weights.reduce((sum, weight, one) => sum + weight * centres[n + 3 * one + axis], 0);
          at += 1;
        }
      }
    }
  }
  return points;
}

/** Create what draws them. */
export function createPrints() {
  const material = new THREE.LineBasicMaterial({ transparent: true, opacity: FAINT, depthWrite: false, depthTest: false });
  const lines = new THREE.LineSegments(new THREE.BufferGeometry(), material);
  lines.renderOrder = 5;
  const group = new THREE.Group();
  group.add(lines);
  return {
    group,
    /** Show the prints of a spread, or nothing. */
    show(centres) {
      lines.geometry.dispose();
      lines.geometry = new THREE.BufferGeometry();
      if (centres) lines.geometry.setAttribute("position", new THREE.BufferAttribute(axesOf(centres), 3));
    },
    setTheme(theme) { material.color = plain(theme.target); },
    dispose() {
      lines.geometry.dispose();
      material.dispose();
    },
  };
}
