// Lines, dots, texts and handles over the canvas: SVG elements at places in space, put where the
// camera sees them ahead of every drawing. They are crisp, styled by the style sheet and operable.

const SPACE = "http://www.w3.org/2000/svg";

const MARKERS = { // centred on the place, px
  dot: ["circle", { r: 4.5 }],
  ring: ["circle", { r: 7 }],
  target: ["path", { d: "M0-8 8 0 0 8-8 0zM0-2.5v5M-2.5 0h5" }],
};
const APART = 34; // px between the ends of a dimension that is shown
const REACH = 15; // px around a marker in which it is hit

/** Create the layer in a container.
 *
 * Items of `set`: { id, kind: "line", a, b } | { kind: "text", at, text, shift: [dx, dy] } |
 * { kind: "dot" | "ring" | "target", at, name?, onPress?, onHover?, onKey? } |
 * { kind: "polygon", points } with `className`; places are [x, y, z] in mm. An item with span: [a, b]
 * is shown only while these two places are seen apart.
 */
export function createAnnotations(container) {
  const svg = globalThis.document.createElementNS(SPACE, "svg");
  svg.setAttribute("class", "shape-notes");
  container.append(svg);
  const shown = new Map(); // id -> { item, element }

  const make = (item) => {
    const element = create("g", {});
    element.dataset.id = item.id;
    element.style.display = "none"; // until it is put in its place
    const marker = MARKERS[item.kind];
    if (item.kind === "line") element.append(create("line", { class: "reach" }), create("line", {}));
    if (item.kind === "polygon") element.append(create("polygon", {}));
    if (item.kind === "text") element.append(create("text", {}));
    if (marker) element.append(create("circle", { r: REACH, class: "reach" }), create(...marker));
    svg.append(element);
    const entry = { element, item };
    const call = (name) => (event) => entry.item[name]?.(event);
    element.addEventListener("pointerdown", (event) => {
      if (!entry.item.onPress) return;
      event.preventDefault();
      event.stopPropagation();
      element.focus?.({ preventScroll: true });
      entry.item.onPress(event);
    });
    element.addEventListener("pointerenter", () => entry.item.onHover?.(true));
    element.addEventListener("pointerleave", () => entry.item.onHover?.(false));
    element.addEventListener("keydown", call("onKey"));
    return entry;
  };

  const update = (entry, item) => {
    const { element } = entry;
    entry.item = item;
    const classes = ["note", `note-${item.kind}`, item.className ?? "", item.onPress ? "operable" : ""];
    element.setAttribute("class", classes.join(" "));
    if (item.kind === "text") element.firstChild.textContent = item.text;
    if (item.onPress) {
      element.setAttribute("tabindex", item.tabindex ?? 0);
      element.setAttribute("role", "button");
      element.setAttribute("aria-label", item.name);
    } else for (const name of ["tabindex", "role", "aria-label"]) element.removeAttribute(name);
  };

  return {
    svg,
    set(items) {
      const ids = new Set(items.map(({ id }) => id));
      for (const [id, { element }] of shown) {
        if (ids.has(id)) continue;
        element.remove();
        shown.delete(id);
      }
      for (const item of items) {
        const known = shown.get(item.id);
        const entry = known && known.item.kind === item.kind ? known : make(item);
        if (known && entry !== known) known.element.remove();
        shown.set(item.id, entry);
        update(entry, item);
      }
    },
    /** Put everything where project([x, y, z]) -> { x, y, seen } says. */
    draw(project) {
      for (const { item, element } of shown.values()) {
        const places = (item.points ?? (item.kind === "line" ? [item.a, item.b] : [item.at])).map(project);
        const wide = !item.span || apart(...item.span.map(project)) > APART;
        const seen = wide && places.every((place) => place.seen);
        element.style.display = seen ? "" : "none";
        if (!seen) continue;
        const [p, q] = places;
        if (item.kind === "line")
          for (const line of element.children) set(line, { x1: p.x, y1: p.y, x2: q.x, y2: q.y });
        else if (item.kind === "polygon")
          set(element.firstChild, {
            points: places.map(({ x, y }) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" "),
          });
        else {
          const [dx, dy] = item.shift ?? [0, 0];
          element.setAttribute("transform", `translate(${(p.x + dx).toFixed(1)} ${(p.y + dy).toFixed(1)})`);
        }
      }
    },
    dispose: () => svg.remove(),
  };
}

const apart = (p, q) => Math.hypot(p.x - q.x, p.y - q.y);

function create(name, attributes) {
  const element = globalThis.document.createElementNS(SPACE, name);
  set(element, attributes);
  return element;
}

function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes))
    element.setAttribute(name, typeof value === "number" ? Number(value.toFixed(1)) : value);
}
