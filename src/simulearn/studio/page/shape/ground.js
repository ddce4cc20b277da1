// What the shape stands over: a grid at the height of the flat sheet and the shape's shadow on it.

import { THREE } from "/libraries/three.js";
import { plain } from "./material.js";

const CELL = 10; // mm between the grid's lines
const STRONG = 5; // every fifth line is stronger
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
uniform float strength;
varying float vOver;
void main() {
  if (vOver < 0.0) discard;
  gl_FragColor = vec4(0.0, 0.0, 0.0, strength);
}`;

/** Create the ground of a scene. */
export function createGround() {
  const group = new THREE.Group();
  const lineMaterial = new THREE.LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false });
  const lines = new THREE.LineSegments(new THREE.BufferGeometry(), lineMaterial);
  lines.renderOrder = 1;
  // Every point of the plane is darkened once: the first fragment keeps the later ones out by depth.
  const shadowMaterial = new THREE.ShaderMaterial({
    vertexShader: SHADOW_VERTEX, fragmentShader: SHADOW_FRAGMENT, transparent: true, depthFunc: THREE.LessDepth,
    side: THREE.DoubleSide, uniforms: { height: { value: 0 }, strength: { value: SHADOW.light } },
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
    const from = [0, 1].map((a) => Math.floor((centre[a] - radius) / CELL));
    const to = [0, 1].map((a) => Math.ceil((centre[a] + radius) / CELL));
    const add = (x, y, strong) => {
      const away = Math.hypot(x - centre[0], y - centre[1]) / radius;
      points.push(x, y, 0);
      colours.push(...theme.lineStrong, Math.max(0, 1 - away ** 2) * (strong ? 0.62 : 0.28));
    };
    for (let i = from[0]; i <= to[0]; i += 1) {
      for (let j = from[1]; j <= to[1]; j += 1) {
        if (i < to[0]) for (const k of [i, i + 1]) add(k * CELL, j * CELL, j % STRONG === 0);
        if (j < to[1]) for (const k of [j, j + 1]) add(i * CELL, k * CELL, i % STRONG === 0);
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
    follow(mesh) { shadow.geometry = mesh.geometry; },
    setTheme(next) {
      theme = next;
      lineMaterial.color = plain([1, 1, 1]);
      shadowMaterial.uniforms.strength.value = theme.dark ? SHADOW.dark : SHADOW.light;
      if (bounds) build(bounds.low, bounds.high);
    },
    setVisible(on) { group.visible = on; },
    dispose() {
      lines.geometry.dispose();
      lineMaterial.dispose();
      shadowMaterial.dispose();
    },
  };
}
