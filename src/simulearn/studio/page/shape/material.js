// The look of the plastic: matte, lit softly from above and from beside the viewer. One program for
// all modes; colours are those of the style sheet, untouched by tone mapping.

import { THREE } from "/libraries/three.js";
import { table } from "./colours.js";

const TEXELS = 256;

const VERTEX = `
attribute float tone;
attribute float value;
attribute float mark;
uniform vec3 palette[5];
varying vec3 vNormal, vView, vTone;
varying float vValue, vMark, vPart;
void main() {
  int k = int(tone + 0.5);
  vTone = k == 0 ? palette[0] : k == 1 ? palette[1] : k == 2 ? palette[2] : k == 3 ? palette[3] : palette[4];
  vPart = k == 1 || k == 2 ? 1.0 : 0.0;
  vValue = value;
  vMark = mark;
  vNormal = normal;
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  vView = normalMatrix * normal;
  gl_Position = projectionMatrix * place;
}`;

const FRAGMENT = `
uniform sampler2D map;
uniform vec2 range;
uniform float mapped, joints, dim, opacity, ambient;
uniform vec3 canvas, accent;
varying vec3 vNormal, vView, vTone;
varying float vValue, vMark, vPart;
void main() {
  float t = clamp((vValue - range.x) / max(range.y - range.x, 1e-9), 0.0, 1.0);
  vec3 colour = mix(vTone, texture2D(map, vec2(t * 0.99609375 + 0.001953125, 0.5)).rgb,
    mapped * max(joints, 1.0 - vPart));
  colour = mix(colour, accent, vMark * 0.62);
  vec3 n = normalize(vNormal);
  vec3 v = normalize(vView);
  float side = gl_FrontFacing ? 1.0 : -1.0;
  float sky = 0.5 + 0.5 * n.z * side;
  float key = max(0.0, 0.35 + 0.65 * dot(v * side, vec3(-0.40, 0.55, 0.73)));
  float light = ambient + 0.18 * sky + 0.38 * key;
  gl_FragColor = vec4(mix(colour * min(light, 1.04), canvas, dim), opacity);
}`;

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
  if (map) uniforms.map.value = mapTexture(map);
}

const textures = new Map();

function mapTexture(name) {
  if (!textures.has(name)) {
    const texture = new THREE.DataTexture(table(name, TEXELS), TEXELS, 1);
    texture.magFilter = THREE.LinearFilter;
    texture.minFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    textures.set(name, texture);
  }
  return textures.get(name);
}

/** Return a colour of a theme as three.js's lines and points take it, without conversion. */
export const plain = (rgb) => new THREE.Color().setRGB(...rgb, THREE.LinearSRGBColorSpace);
