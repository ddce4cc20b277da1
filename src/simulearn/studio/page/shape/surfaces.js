// Surfaces on which the grid is to lie: translucent, with a net of lines at even distances.

import { THREE } from "/libraries/three.js";
import { plain } from "./material.js";
import { cellOf } from "./net.js";

const SHEER = { light: 0.16, dark: 0.22 }; // how much of the colour is seen
const CREASE = 30; // degrees between faces, from which on their edge is drawn

const VERTEX = `
varying vec3 vPlace, vNormal, vSeen;
void main() {
  vPlace = position;
  vNormal = normal;
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  vSeen = normalize(normalMatrix * normal);
  gl_Position = projectionMatrix * seen;
}`;

const FRAGMENT = `
uniform vec3 colour;
uniform float sheer, cell;
varying vec3 vPlace, vNormal, vSeen;
void main() {
  // A line of the net where a coordinate is a multiple of the cell, unless the surface runs along it.
  vec3 part = vPlace / cell;
  vec3 wide = max(fwidth(part), vec3(1e-6));
  vec3 line = 1.0 - smoothstep(vec3(0.4), vec3(1.2), abs(fract(part - 0.5) - 0.5) / wide);
  vec3 across = smoothstep(0.2, 0.6, 1.0 - abs(normalize(vNormal)));
  float net = max(line.x * across.x, line.y * across.y);
  float rim = 1.0 - abs(normalize(vSeen).z);
  gl_FragColor = vec4(colour, clamp(sheer * (0.75 + 1.1 * rim) + 0.32 * net, 0.0, 0.75));
}`;

/** Create what draws surfaces. */
export function createSurfaces() {
  const group = new THREE.Group();
  let [shown, theme] = [[], null];
  const parts = new Map(); // vertices of a surface -> { mesh, lines }

  const make = ({ vertices, faces }) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(vertices.flat(), 3));
    geometry.setIndex(faces.flat());
    geometry.computeVertexNormals();
    geometry.computeBoundingBox();
    const size = geometry.boundingBox.getSize(new THREE.Vector3());
    const mesh = new THREE.Mesh(geometry, new THREE.ShaderMaterial({
      vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: true, depthWrite: false, side: THREE.DoubleSide,
      uniforms: {
        colour: { value: new THREE.Vector3() }, sheer: { value: SHEER.light },
        cell: { value: cellOf(Math.max(size.x, size.y, size.z, 1e-3)) },
      },
    }));
    const lines = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, CREASE), new THREE.LineBasicMaterial({
      transparent: true, opacity: 0.55, depthWrite: false,
    }));
    mesh.renderOrder = 4;
    lines.renderOrder = 4;
    group.add(mesh, lines);
    return { mesh, lines };
  };
  const paint = ({ mesh, lines }) => {
    if (!theme) return;
    mesh.material.uniforms.colour.value.fromArray(theme.target);
    mesh.material.uniforms.sheer.value = theme.dark ? SHEER.dark : SHEER.light;
    lines.material.color = plain(theme.target);
  };
  const remove = (key) => {
    for (const object of Object.values(parts.get(key))) {
      group.remove(object);
      object.geometry.dispose();
      object.material.dispose();
    }
    parts.delete(key);
  };

  return {
    group,
    get shown() { return shown; },
    /** Show surfaces { vertices, faces }; those that are there already stay as they are. */
    show(surfaces) {
      shown = surfaces;
      const kept = new Set(surfaces.map(({ vertices }) => vertices));
      for (const key of [...parts.keys()]) if (!kept.has(key)) remove(key);
      for (const surface of surfaces) {
        if (parts.has(surface.vertices)) continue;
        parts.set(surface.vertices, make(surface));
        paint(parts.get(surface.vertices));
      }
    },
    setTheme(next) {
      theme = next;
      for (const part of parts.values()) paint(part);
    },
    dispose() {
      for (const key of [...parts.keys()]) remove(key);
    },
  };
}
