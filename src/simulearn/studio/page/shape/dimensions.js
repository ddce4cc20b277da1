// Width, depth and height of a shape as lines with numbers at its box.

const AWAY = 0.06; // of the largest side, between the shape and its dimension lines
const LEAST = 6; // mm, of that distance
const TICK = 3; // mm, of the lines at the ends

/** Return the items of the annotations for the box low to high; text(mm) writes a number. */
export function dimensionItems({ low, high }, text) {
  const size = high.map((x, axis) => x - low[axis]);
  const away = Math.max(LEAST, AWAY * Math.max(...size));
  const [x0, y0, z0] = low;
  const [x1, y1, z1] = high;
  const y = y0 - away;
  const x = x1 + away;
  return [
    ...dimension("width", [x0, y, z0], [x1, y, z0], [0, TICK, 0], text(size[0])),
    ...dimension("depth", [x, y0, z0], [x, y1, z0], [TICK, 0, 0], text(size[1])),
    ...dimension("height", [x, y, z0], [x, y, z1], [TICK, 0, 0], text(size[2])),
  ];
}

function dimension(id, a, b, tick, text) {
  const shifted = (point, sign) => point.map((x, axis) => x + sign * tick[axis]);
  const end = (name, p) => ({
    id: `${id}-${name}`, kind: "line", className: "note-dimension", span: [a, b],
    a: shifted(p, 1), b: shifted(p, -1),
  });
  return [
    { id: `${id}-line`, kind: "line", className: "note-dimension", a, b, span: [a, b] },
    end("from", a), end("to", b),
    {
      id: `${id}-text`, kind: "text", className: "note-dimension", text, span: [a, b],
      at: a.map((x, k) => (x + b[k]) / 2),
    },
  ];
}
