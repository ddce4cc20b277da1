// The grid in the scene: one mesh and one set of lines, whose arrays are overwritten for every frame.

import { THREE } from "/libraries/three.js";
import { COLOURINGS, calmRange } from "./colours.js";
import { outlineMaterial, paintWith, plain, surfaceMaterial, useMap } from "./material.js";
import { createSkin, placeSkin } from "./skin.js";
import { fillValues, hasValues, rangeOf } from "./values.js";

const MARKS = { plain: 0, hover: 120, selected: 255 };

/** Create the drawing of a result.
 *
 * opacity below 1 is for results that lie over another, 0 for edges alone, which are then seen through
 * all else; one: the theme's colour that all of it has;
 * spacing: of the stations along a beam, mm.
 */
export function createBody({ opacity = 1, edges = 0.3, one = null, spacing } = {}) {
  const material = surfaceMaterial({ opacity });
  const lineMaterial = new THREE.LineBasicMaterial({ transparent: true, opacity: edges, depthWrite: false });
  lineMaterial.depthTest = opacity > 0;
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
  const lines = new THREE.LineSegments(new THREE.BufferGeometry(), lineMaterial);
  const outline = new THREE.Mesh(mesh.geometry, outlineMaterial());
  const group = new THREE.Group();
  group.add(mesh, lines, outline);
  mesh.visible = opacity > 0;
  for (const object of group.children) object.frustumCulled = false;
  group.visible = false;
  let [skin, shown, frame, by, reference, range] = [null, null, 11, "actuator", null, [0, 1]];

  const attach = () => {
    const { positions, normals, values, tones, marks, index, lines: pairs } = skin.storage;
    const changing = (array, size, normalized = false) =>
      new THREE.BufferAttribute(array, size, normalized).setUsage(THREE.DynamicDrawUsage);
    for (const object of [mesh, lines]) {
      object.geometry.dispose();
      object.geometry = new THREE.BufferGeometry();
    }
    const place = changing(positions, 3);
    mesh.geometry.setAttribute("position", place);
    mesh.geometry.setAttribute("normal", changing(normals, 3));
    mesh.geometry.setAttribute("value", changing(values, 1));
    mesh.geometry.setAttribute("tone", changing(tones, 1));
    mesh.geometry.setAttribute("mark", changing(marks, 1, true));
    mesh.geometry.setIndex(changing(index, 1));
    lines.geometry.setAttribute("position", place); // the same numbers, on the device too
    lines.geometry.setIndex(changing(pairs, 1));
    outline.geometry = mesh.geometry;
  };
  const upload = (names) => {
    for (const name of names) mesh.geometry.attributes[name].needsUpdate = true;
  };
  const fill = () => {
    if (COLOURINGS[by].map === null) return;
    fillValues(skin, shown.result, by, frame, reference);
    upload(["value"]);
  };
  const place = () => {
    placeSkin(skin, shown.result, frame);
    upload(["position", "normal"]);
    fill();
  };
  const colour = () => {
    const possible = hasValues(by, shown.result, reference);
    if (!possible) by = "actuator";
    const { map } = COLOURINGS[by];
    range = map ? calmRange(rangeOf(by, shown.result, reference)) : [0, 1];
    useMap(material, map, range, by === "height" || by === "deviation");
  };

  return {
    group, mesh, material,
    get skin() { return skin; },
    get shown() { return shown; },
    get range() { return range; },
    get by() { return by; },
    /** Show a result of a grid; the same arrays are used again while they are large enough. */
    show(result, grid) {
      group.visible = result !== null;
      if (result === null) {
        shown = null;
        return;
      }
      const before = skin?.storage;
      shown = { result, grid };
      skin = createSkin(result, grid, { storage: before, spacing });
      if (skin.storage !== before) attach();
      else {
        upload(["tone"]);
        mesh.geometry.index.needsUpdate = true;
        lines.geometry.index.needsUpdate = true;
      }
      mesh.geometry.setDrawRange(0, skin.indexCount);
      lines.geometry.setDrawRange(0, skin.lineCount);
      skin.storage.marks.fill(0);
      upload(["mark"]);
      outline.visible = false;
      colour();
      place();
    },
    setFrame(next) {
      if (next === frame) return;
      frame = next;
      if (shown) place();
    },
    setColour(next, other = null) {
      by = next;
      reference = other;
      if (!shown) return;
      colour();
      fill();
    },
    /** Mark parts, by their numbers in the document. */
    setMarks({ joints = [], beams = [], hover = null }) {
      if (!shown) return;
      outline.visible = false;
      for (const { kind, number, firstVertex, vertexCount } of skin.parts) {
        const selected = (kind === "joint" ? joints : beams).includes(number);
        const mark = selected ? MARKS.selected : hover?.[kind] === number ? MARKS.hover : MARKS.plain;
        outline.visible ||= mark > 0;
        skin.storage.marks.fill(mark, firstVertex, firstVertex + vertexCount);
      }
      upload(["mark"]);
    },
    /** Draw what is dear, the edges, or not. */
    setPlain(on) { lines.visible = !on; },
    setSize(width, height) { outline.material.uniforms.size.value.set(width, height); },
    setDim(dim) {
      material.uniforms.dim.value = dim;
      lineMaterial.opacity = edges * (1 - 0.6 * dim);
    },
    setTheme(theme) {
      const names = ["beam", "joint", "top", "bottom"];
      const same = one && Object.fromEntries(names.map((name) => [name, theme[one]]));
      paintWith(material, { ...theme, ...same });
      outline.material.uniforms.accent.value.fromArray(theme.accent);
      lineMaterial.color = plain(theme[one ?? "text"]);
    },
    dispose() {
      mesh.geometry.dispose();
      lines.geometry.dispose();
      material.uniforms.map.value.dispose();
      material.dispose();
      outline.material.dispose();
      lineMaterial.dispose();
    },
  };
}
