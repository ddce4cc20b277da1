// A toolpath in the scene: ribbons by role up to a layer, travels, and the bed.

import { THREE } from "/libraries/three.js";
import { bedLines } from "./bed.js";
import { plain } from "./material.js";
import { ribbonsOf, TONES } from "./ribbons.js";

const FADED = { light: 0.62, dark: 0.58 }; // of layers below the current one, towards the canvas

const VERTEX = `
attribute float tone, side;
uniform vec3 palette[${TONES.length}];
varying vec3 vColour;
varying float vSide;
void main() {
  int k = int(tone + 0.5);
  vColour = ${TONES.map((_, k) => (k ? `k == ${k} ? palette[${k}] : ` : "")).join("")}palette[0];
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
  const palette = TONES.map(() => new THREE.Vector3());
  const canvas = new THREE.Vector3();
  const material = (faded) => new THREE.ShaderMaterial({
    vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide,
    uniforms: { palette: { value: palette }, canvas: { value: canvas }, faded: { value: faded } },
  });
  const materials = [material(FADED.light), material(0)];
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), materials);
  const travelMaterials = { // dashed where filament is drawn back
    drawn: new THREE.LineDashedMaterial({ dashSize: 1.6, gapSize: 1.2, transparent: true, opacity: 0.8 }), // mm
    kept: new THREE.LineBasicMaterial({ transparent: true, opacity: 0.8 }),
  };
  const travels = Object.entries(travelMaterials).map(([kind, one]) => (
    { kind, lines: new THREE.LineSegments(new THREE.BufferGeometry(), one) }));
  const bedMaterial = new THREE.LineBasicMaterial();
  const cellMaterial = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.4 });
  const bed = new THREE.LineSegments(new THREE.BufferGeometry(), bedMaterial);
  const cells = new THREE.LineSegments(new THREE.BufferGeometry(), cellMaterial);
  const zoneMaterial = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 });
  const zones = new THREE.LineSegments(new THREE.BufferGeometry(), zoneMaterial);
  const group = new THREE.Group();
  group.add(mesh, ...travels.map(({ lines }) => lines), bed, cells, zones);
  for (const one of group.children) one.frustumCulled = false;
  let [ribbons, path] = [null, null];

  const replace = (object, positions) => {
    object.geometry.dispose();
    object.geometry = new THREE.BufferGeometry();
    object.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(positions), 3));
  };
  const buildBed = (box) => {
    const { outline, cells: squares, excluded } = bedLines(box);
    replace(bed, outline);
    replace(cells, squares);
    replace(zones, excluded);
  };

  return {
    group,
    get path() { return path; },
    /** Show a toolpath (or none) on a bed { shape, low: [x, y], high, excluded }. */
    show(toolpath, box) {
      path = toolpath;
      if (toolpath === null) return;
      ribbons = ribbonsOf(toolpath);
      replace(mesh, ribbons.positions);
      mesh.geometry.setAttribute("side", new THREE.BufferAttribute(ribbons.sides, 1));
      mesh.geometry.setAttribute("tone", new THREE.BufferAttribute(ribbons.tones, 1));
      mesh.geometry.setIndex(new THREE.BufferAttribute(ribbons.index, 1));
      for (const { kind, lines } of travels) {
        replace(lines, ribbons.travels[kind].points);
        lines.computeLineDistances();
      }
      for (const one of [bed, cells, zones]) one.visible = box !== null;
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
      for (const { kind, lines } of travels) {
        lines.visible = withTravels;
        const [first, end] = ribbons.travels[kind].start.slice(k, k + 2);
        lines.geometry.setDrawRange(first, end - first);
      }
    },
    setTheme(theme) {
      const mix = (a, b, t) => a.map((x, k) => x + t * (b[k] - x));
      const { beam, joint, text, bottom, top, canvas: back } = theme;
      const colours = { // as in style/panels.css
        skirt: mix(beam, back, 0.4), shell: mix(joint, text, 0.45), active: bottom, passive: beam, joint,
        upper: top, brim: theme.brim,
      };
      TONES.forEach((tone, k) => palette[k].fromArray(colours[tone]));
      canvas.fromArray(theme.canvas);
      materials[0].uniforms.faded.value = theme.dark ? FADED.dark : FADED.light;
      travelMaterials.drawn.color = plain(theme.accent);
      travelMaterials.kept.color = plain(theme.textSoft);
      bedMaterial.color = plain(theme.lineStrong);
      cellMaterial.color = plain(theme.line);
      zoneMaterial.color = plain(theme.error);
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
      for (const one of [...materials, ...Object.values(travelMaterials), bedMaterial, cellMaterial, zoneMaterial]) one.dispose();
    },
  };
}
