// The look of the plastic: matte, lit softly from above and from beside the viewer. One program for
// all modes; colours are those of the style sheet, untouched by tone mapping.

import { THREE } from "/libraries/three.js";
import { table } from "./colours.js";

const TEXELS = 256;

// The light is that of the vertices: they are shared where the surface is smooth and nowhere else.
const VERTEX = `
attribute float tone, value, mark;
uniform vec3 palette[5], accent;
uniform vec2 range;
uniform float joints, ambient;
varying vec4 vColour;
varying vec3 vValue;
void main() {
  int k = int(tone + 0.5);
  vec3 colour = k == 0 ? palette[0] : k == 1 ? palette[1] : k == 2 ? palette[2]
    : k == 3 ? palette[3] : palette[4];
  float sky = 0.5 + 0.5 * normal.z;
  vec3 seen = normalize(normalMatrix * normal);
  float key = max(0.0, 0.35 + 0.65 * dot(seen, vec3(-0.40, 0.55, 0.73)));
  vColour = vec4(colour, min(1.04, ambient + 0.18 * sky + 0.38 * key));
  float share = (value - range.x) / max(range.y - range.x, 1e-9);
  vValue = vec3(share, k == 1 || k == 2 ? joints : 1.0, mark * 0.22);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const FRAGMENT = `
uniform sampler2D map;
uniform float mapped, dim, opacity;
uniform vec3 canvas, accent;
varying vec4 vColour;
varying vec3 vValue;
void main() {
  vec3 colour = vColour.rgb;
  if (mapped > 0.5) {
    // from the first texel's middle to the last's
    float t = clamp(vValue.x, 0.0, 1.0) * 0.99609375 + 0.001953125;
    colour = mix(colour, texture2D(map, vec2(t, 0.5)).rgb, vValue.y);
  }
  colour = mix(colour, accent, vValue.z) * vColour.a;
  gl_FragColor = vec4(mix(colour, canvas, dim), opacity);
}`;

const OUTLINE_VERTEX = `
attribute float mark;
uniform vec2 size;
void main() {
  vec4 place = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  vec4 ahead = projectionMatrix * modelViewMatrix * vec4(position + normal, 1.0);
  vec2 along = (ahead.xy / ahead.w - place.xy / place.w) * size;
  float wide = (mark > 0.9 ? 3.2 : 2.0) * min(1.0, length(along) / 0.5);
  place.xy += normalize(along + vec2(1e-6)) * 2.0 * wide / size * place.w;
  gl_Position = mark > 0.0 ? place : vec4(2.0, 2.0, 2.0, 1.0);
}`;

const OUTLINE_FRAGMENT = `
uniform vec3 accent;
void main() { gl_FragColor = vec4(accent, 1.0); }`;

/** Return the material of the outline of marked parts: their far sides, some pixels larger. */
export function outlineMaterial() {
  return new THREE.ShaderMaterial({
    vertexShader: OUTLINE_VERTEX,
    fragmentShader: OUTLINE_FRAGMENT,
    side: THREE.BackSide,
    uniforms: { accent: { value: new THREE.Vector3() }, size: { value: new THREE.Vector2(1, 1) } },
  });
}

/** Return the material of a grid's surface; its uniforms are set by `paintWith` and `useMap`. */
export function surfaceMaterial({ opacity = 1 } = {}) {
  return new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    transparent: opacity < 1,
    depthWrite: opacity === 1,
    polygonOffset: true, // edges are drawn on the surface
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    uniforms: {
      palette: { value: Array.from({ length: 5 }, () => new THREE.Vector3()) },
      canvas: { value: new THREE.Vector3() },
      accent: { value: new THREE.Vector3() },
      map: { value: mapTexture("viridis") },
      range: { value: new THREE.Vector2(0, 1) },
      mapped: { value: 0 },
      joints: { value: 0 },
      dim: { value: 0 },
      opacity: { value: opacity },
      ambient: { value: 0.5 },
    },
  });
}

/** Give a material the colours of a theme. */
export function paintWith({ uniforms }, theme) {
  const fixed = theme.joint.map((x, k) => x + 0.45 * (theme.text[k] - x));
  [theme.beam, theme.joint, fixed, theme.top, theme.bottom].forEach((colour, k) => {
    uniforms.palette.value[k].fromArray(colour);
  });
  uniforms.canvas.value.fromArray(theme.canvas);
  uniforms.accent.value.fromArray(theme.accent);
  uniforms.ambient.value = theme.dark ? 0.40 : 0.48;
}

/** Colour by values: the map's name (null for the parts' own colours), the range, and whether joints
 * have values. */
export function useMap({ uniforms }, map, range = [0, 1], joints = true) {
  uniforms.mapped.value = map ? 1 : 0;
  uniforms.joints.value = joints ? 1 : 0;
  uniforms.range.value.fromArray(range);
  if (!map || uniforms.map.value.name === map) return;
  uniforms.map.value.dispose();
  uniforms.map.value = mapTexture(map);
}

function mapTexture(name) {
  const texture = new THREE.DataTexture(table(name, TEXELS), TEXELS, 1);
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  texture.name = name;
  return texture;
}

/** Return a colour of a theme as three.js's lines and points take it, without conversion. */
export const plain = (rgb) => new THREE.Color().setRGB(...rgb, THREE.LinearSRGBColorSpace);
