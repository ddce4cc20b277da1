// The directions x, y and z, small in a corner; a press looks along one of them.

const SPACE = "http://www.w3.org/2000/svg";
const LENGTH = 20; // px
const AXES = { x: { view: "side", at: 0 }, y: { view: "front", at: 1 }, z: { view: "top", at: 2 } };

/** Create the triad in an element; onPress(view) is called with the name of a view. */
export function createTriad(container, onPress) {
  const svg = make("svg", {
    class: "shape-triad", viewBox: "-32 -32 64 64", width: 64, height: 64, "aria-hidden": "true",
  });
  const axes = Object.entries(AXES).map(([name, { view }]) => {
    const group = make("g", { class: name });
    const text = make("text", {});
    text.textContent = name;
    group.append(make("line", {}), make("circle", { r: 8 }), text);
    group.addEventListener("click", () => onPress(view));
    return group;
  });
  svg.append(...axes);
  container.append(svg);
  return {
    /** Turn with a camera (three.js), whose axes are the columns of its matrix. */
    turn(camera) {
      const m = camera.matrixWorld.elements;
      const depth = [];
      Object.values(AXES).forEach(({ at }, k) => {
        const [x, y] = [LENGTH * m[at], -LENGTH * m[4 + at]];
        depth.push([m[8 + at], k]);
        const [line, circle, text] = axes[k].children;
        set(line, { x2: x.toFixed(1), y2: y.toFixed(1) });
        set(circle, { cx: (1.2 * x).toFixed(1), cy: (1.2 * y).toFixed(1) });
        set(text, { x: (1.2 * x).toFixed(1), y: (1.2 * y).toFixed(1) });
      });
      const next = depth.sort((a, b) => a[0] - b[0]).map(([, k]) => axes[k]); // the nearest one last
      if (next.some((group, k) => group !== svg.children[k])) svg.append(...next);
    },
    dispose: () => svg.remove(),
  };
}

function make(name, attributes) {
  const element = globalThis.document.createElementNS(SPACE, name);
  set(element, attributes);
  return element;
}

function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
}
