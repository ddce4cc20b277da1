// A toolpath in the scene: ribbons by role up to a layer, travels, and the bed.

import { THREE } from "/libraries/three.js";
import { plain } from "./material.js";
import { ribbonsOf } from "./ribbons.js";

const TONES = 6; // roles, and active beads of the upper half
const FADED = { light: 0.62, dark: 0.58 }; // of layers below the current one, towards the canvas

const VERTEX = `
attribute float tone, side;
uniform vec3 palette[${TONES}];
varying vec3 vColour;
varying float vSide;
void main() {
  int k = int(tone + 0.5);
  vColour = k == 0 ? palette[0] : k == 1 ? palette[1] : k == 2 ? palette[2] : k == 3 ? palette[3]
    : k == 4 ? palette[4] : palette[5];
  vSide = side;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

// A bead is round: its edges are darker.
const FRAGMENT = `
uniform vec3 canvas;
uniform float faded;
varying vec3 vColour;
varying float vSide;
void main() {
  float round = 0.70 + 0.34 * sqrt(max(0.0, 1.0 - vSide * vSide));
  gl_FragColor = vec4(mix(vColour * round, canvas, faded), 1.0);
}`;

/** Create the drawing of a print. */
export function createPrint() {
  const palette = Array.from({ length: TONES }, () => new THREE.Vector3());
  const canvas = new THREE.Vector3();
  const material = (faded) => new THREE.ShaderMaterial({
    vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide,
    uniforms: { palette: { value: palette }, canvas: { value: canvas }, faded: { value: faded } },
  });
  const materials = [material(FADED.light), material(0)];
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), materials);
  const travelMaterial = new THREE.LineDashedMaterial({
    dashSize: 1.6, gapSize: 1.2, transparent: true, opacity: 0.8, // mm
  });
  const travels = new THREE.LineSegments(new THREE.BufferGeometry(), travelMaterial);
  const bedMaterial = new THREE.LineBasicMaterial();
  const cellMaterial = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.4 });
  const bed = new THREE.LineSegments(new THREE.BufferGeometry(), bedMaterial);
  const cells = new THREE.LineSegments(new THREE.BufferGeometry(), cellMaterial);
  const group = new THREE.Group();
  group.add(mesh, travels, bed, cells);
  for (const one of group.children) one.frustumCulled = false;
  let [ribbons, path] = [null, null];

  const replace = (object, positions) => {
    object.geometry.dispose();
    object.geometry = new THREE.BufferGeometry();
    object.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(positions), 3));
  };
  const buildBed = ({ low, high }) => {
    const [[x0, y0], [x1, y1]] = [low, high];
    replace(bed, [x0, y0, 0, x1, y0, 0, x1, y0, 0, x1, y1, 0, x1, y1, 0, x0, y1, 0, x0, y1, 0, x0, y0, 0]);
    const points = [];
    for (let x = Math.ceil(x0 / 20) * 20; x <= x1; x += 20) points.push(x, y0, 0, x, y1, 0);
    for (let y = Math.ceil(y0 / 20) * 20; y <= y1; y += 20) points.push(x0, y, 0, x1, y, 0);
    replace(cells, points);
  };

  return {
    group,
    get path() { return path; },
    /** Show a toolpath (or none) on a bed { low: [x, y], high }. */
    show(toolpath, box) {
      path = toolpath;
      if (toolpath === null) return;
      ribbons = ribbonsOf(toolpath);
      replace(mesh, ribbons.positions);
      mesh.geometry.setAttribute("side", new THREE.BufferAttribute(ribbons.sides, 1));
      mesh.geometry.setAttribute("tone", new THREE.BufferAttribute(ribbons.tones, 1));
      mesh.geometry.setIndex(new THREE.BufferAttribute(ribbons.index, 1));
      replace(travels, ribbons.travels);
      travels.computeLineDistances();
      bed.visible = box !== null;
      cells.visible = box !== null;
      if (box) buildBed(box);
    },
    /** Show the layers 1 to `layer`, the last of them clearly; travels are those of the last one. */
    setLayer(layer, withTravels) {
      if (!ribbons) return;
      const k = Math.min(ribbons.layerStart.length - 1, Math.max(1, layer)) - 1;
      const [from, to] = [ribbons.layerStart[k], ribbons.layerStart[k + 1]];
      mesh.geometry.clearGroups();
      mesh.geometry.addGroup(0, from, 0);
      mesh.geometry.addGroup(from, to - from, 1);
      travels.visible = withTravels;
      const [first, end] = [ribbons.travelStart[k], ribbons.travelStart[k + 1]];
      travels.geometry.setDrawRange(first, end - first);
    },
    setTheme(theme) {
      const mix = (a, b, t) => a.map((x, k) => x + t * (b[k] - x));
      const { beam, joint, text, bottom, top } = theme;
      // skirt, shell, active in the lower half, passive, joint, active in the upper half
      [mix(beam, theme.canvas, 0.4), mix(joint, text, 0.45), bottom, beam, joint, top]
        .forEach((colour, k) => palette[k].fromArray(colour));
      canvas.fromArray(theme.canvas);
      materials[0].uniforms.faded.value = theme.dark ? FADED.dark : FADED.light;
      travelMaterial.color = plain(theme.accent);
      bedMaterial.color = plain(theme.lineStrong);
      cellMaterial.color = plain(theme.line);
    },
    /** Return the corners of what is printed and of the bed, to be brought into view. */
    points() {
      return [mesh, bed].flatMap((object) => {
        object.geometry.computeBoundingBox();
        const { min, max } = object.geometry.boundingBox ?? {};
        return min ? [min.x, max.x].flatMap((x) => [[x, min.y, min.z], [x, max.y, max.z]]) : [];
      });
    },
    dispose() {
      for (const { geometry } of group.children) geometry.dispose();
      for (const one of [...materials, travelMaterial, bedMaterial, cellMaterial]) one.dispose();
    },
  };
}
