// What the shape stands over: a grid at the height of the flat sheet and the shape's shadow on it.

import { THREE } from "/libraries/three.js";
import { plain } from "./material.js";

const CELL = 10; // mm between the grid's lines
const STRONG = 5; // every fifth line is stronger
const MANY = 60; // lines across, from which on only the strong ones are drawn
const PIECES = 12; // of a line, along which it fades
const BEYOND = 0.35; // of the sheet's size that the grid goes on around it
const BELOW = 0.15; // mm under the sheet, so that they do not flicker through one another
const SHADOW = { light: 0.1, dark: 0.3 };

const SHADOW_VERTEX = `
uniform float height;
varying float vOver;
void main() {
  vec4 place = modelMatrix * vec4(position, 1.0);
  vOver = place.z - height;
  place.z = height;
  gl_Position = projectionMatrix * viewMatrix * place;
}`;

const SHADOW_FRAGMENT = `
uniform vec3 shade;
varying float vOver;
void main() {
  if (vOver < 0.0) discard;
  gl_FragColor = vec4(shade, 1.0);
}`;

/** Create the ground of a scene. */
export function createGround() {
  const group = new THREE.Group();
  const lineMaterial = new THREE.LineBasicMaterial({
    vertexColors: true, transparent: true, depthWrite: false,
  });
  const lines = new THREE.LineSegments(new THREE.BufferGeometry(), lineMaterial);
  lines.renderOrder = 1;
  // The darker of the shadow and what is there: parts over one another darken the ground once.
  const shadowMaterial = new THREE.ShaderMaterial({
    vertexShader: SHADOW_VERTEX, fragmentShader: SHADOW_FRAGMENT, transparent: true, depthWrite: false,
    blending: THREE.CustomBlending, blendEquation: THREE.MinEquation, side: THREE.DoubleSide,
    uniforms: { height: { value: 0 }, shade: { value: new THREE.Vector3() } },
  });
  const shadow = new THREE.Mesh(new THREE.BufferGeometry(), shadowMaterial);
  shadow.frustumCulled = false;
  shadow.renderOrder = 2;
  group.add(lines, shadow);
  let [extent, theme] = ["", null];

  const build = (low, high) => {
    const [points, colours] = [[], []];
    const size = Math.max(high[0] - low[0], high[1] - low[1]);
    const reach = BEYOND * size + CELL;
    const centre = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    const radius = size / 2 + reach;
    const cell = (2 * radius) / CELL > MANY ? CELL * STRONG : CELL;
    const strength = ([x, y]) => Math.max(0, 1 - Math.hypot(x - centre[0], y - centre[1]) ** 2 / radius ** 2);
    for (const axis of [0, 1]) {
      const from = Math.ceil((centre[axis] - radius) / cell) * cell;
      for (let x = from; x <= centre[axis] + radius; x += cell) {
        const strong = Math.round(x / CELL) % STRONG === 0 ? 0.6 : 0.28;
        for (let k = 0; k < PIECES; k += 1) {
          const ends = [k, k + 1].map((n) => centre[1 - axis] + radius * ((2 * n) / PIECES - 1))
            .map((y) => (axis === 0 ? [x, y] : [y, x]));
          if (ends.every((end) => strength(end) === 0)) continue;
          for (const end of ends) {
            points.push(...end, 0);
            colours.push(...theme.lineStrong, strong * strength(end));
          }
        }
      }
    }
    lines.geometry.dispose();
    lines.geometry = new THREE.BufferGeometry();
    lines.geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
    lines.geometry.setAttribute("color", new THREE.Float32BufferAttribute(colours, 4));
  };

  let bounds = null;
  return {
    group,
    /** Lie under a flat sheet of the corners low and high; the shadow is that of `body`'s mesh. */
    place({ low, high }, body) {
      bounds = { low, high };
      shadow.geometry = body.geometry;
      lines.position.z = low[2] - BELOW;
      shadowMaterial.uniforms.height.value = low[2] - BELOW;
      const next = [...low, ...high].map((x) => Math.round(x / CELL)).join();
      if (next === extent) return;
      extent = next;
      build(low, high);
    },
    setTheme(next) {
      theme = next;
      lineMaterial.color = plain([1, 1, 1]);
      const light = 1 - (theme.dark ? SHADOW.dark : SHADOW.light);
      shadowMaterial.uniforms.shade.value.fromArray(theme.canvas.map((x) => x * light));
      if (bounds) build(bounds.low, bounds.high);
    },
    /** Draw what is dear, the shadow, or not. */
    setPlain(on) { shadow.visible = !on; },
    dispose() {
      lines.geometry.dispose();
      lineMaterial.dispose();
      shadowMaterial.dispose();
    },
  };
}
