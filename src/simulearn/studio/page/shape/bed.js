// The bed of a printer as lines: its outline, cells of 20 mm, and hatched zones where nothing is printed.

const CELL = 20; // mm
const HATCH = 6; // mm between lines
const AROUND = 96; // sides of a round bed

/** Return { outline, cells, excluded } of a bed { shape, low, high, excluded }: ends of lines, flat. */
export function bedLines({ shape, low, high, excluded = [] }) {
  const round = shape === "round";
  return {
    outline: round ? ring(low, high) : frame(low, high),
    cells: cells(low, high, round),
    excluded: excluded.flatMap(([a, b]) => {
      const [from, to] = [[0, 1].map((k) => Math.min(a[k], b[k])), [0, 1].map((k) => Math.max(a[k], b[k]))];
      return [...frame(from, to), ...hatch(from, to)];
    }),
  };
}

function frame([x0, y0], [x1, y1]) {
  return [x0, y0, 0, x1, y0, 0, x1, y0, 0, x1, y1, 0, x1, y1, 0, x0, y1, 0, x0, y1, 0, x0, y0, 0];
}

function ring(low, high) {
  const [middle, half] = halves(low, high);
  const at = (n) => {
    const angle = (2 * Math.PI * n) / AROUND;
    return [middle[0] + half[0] * Math.cos(angle), middle[1] + half[1] * Math.sin(angle), 0];
  };
  return Array.from({ length: AROUND }, (_, n) => [...at(n), ...at(n + 1)]).flat();
}

function cells(low, high, round) {
  const [middle, half] = halves(low, high);
  const lines = [];
  for (const [axis, other] of [[0, 1], [1, 0]]) {
    for (let at = Math.ceil(low[axis] / CELL) * CELL; at <= high[axis]; at += CELL) {
      const aside = (at - middle[axis]) / half[axis]; // of a round bed only the chord is drawn
      const part = round ? Math.sqrt(Math.max(0, 1 - aside * aside)) : 1;
      for (const sign of [-1, 1]) {
        const point = [0, 0, 0];
        point[axis] = at;
        point[other] = middle[other] + sign * part * half[other];
        lines.push(...point);
      }
    }
  }
  return lines;
}

/** Return lines aslant, x - y the same along each, within a rectangle. */
function hatch([x0, y0], [x1, y1]) {
  const lines = [];
  for (let d = x0 - y1 + HATCH; d < x1 - y0; d += HATCH)
    lines.push(Math.max(x0, y0 + d), Math.max(y0, x0 - d), 0, Math.min(x1, y1 + d), Math.min(y1, x1 - d), 0);
  return lines;
}

function halves(low, high) {
  return [low.map((x, k) => (x + high[k]) / 2), low.map((x, k) => (high[k] - x) / 2)];
}
