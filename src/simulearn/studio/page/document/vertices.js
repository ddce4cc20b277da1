// Vertices and faces of a grid by their names in a goal, as a task file has them.

export const SECTIONS = ["start", "middle", "end"];

/** Return whether a grid has a vertex: ["joint", k, place] or ["beam", b, section, place]. */
export function hasVertex(grid, vertex) {
  if (!Array.isArray(vertex)) return false;
  const [part, number, ...rest] = vertex;
  if (part === "joint")
    return rest.length === 1 && isIndex(number, grid.joints.length) && isCorner(rest[0], 8);
  return (
    part === "beam" && rest.length === 2 && isIndex(number, grid.beams.length)
    && SECTIONS.includes(rest[0]) && isCorner(rest[1], 4)
  );
}

/** Return whether a grid has a face: of a joint its "top" or a side 0 to 3, of a beam ["beam", b] and
 * perhaps a section and "top". */
export function hasFace(grid, face) {
  if (!Array.isArray(face)) return false;
  const [part, number, ...rest] = face;
  if (part === "joint") {
    const [side] = rest;
    return rest.length === 1 && isIndex(number, grid.joints.length) && (side === "top" || isIndex(side, 4));
  }
  const [section = "middle", top = "top"] = rest;
  return (
    part === "beam" && rest.length <= 2 && isIndex(number, grid.beams.length)
    && SECTIONS.includes(section) && top === "top"
  );
}

/** Return a vertex or face with its section by name; task files may number them. */
export function named(words) {
  if (!Array.isArray(words) || words[0] !== "beam" || !isIndex(words[2], 3)) return words;
  return words.map((word, k) => (k === 2 ? SECTIONS[word] : word));
}

/** Return a face where its vertices went, by vertexOf(vertex) -> vertex or null; null if it is gone. */
export function followedFace(face, vertexOf) {
  const [part, number, ...rest] = face;
  if (part === "joint") {
    const [side] = rest;
    if (side === "top") {
      const centre = vertexOf(["joint", number, "centre"]);
      return centre && ["joint", centre[1], side];
    }
    const ends = [side, (side + 1) % 4].map((corner) => vertexOf(["joint", number, corner]));
    if (ends.includes(null)) return null;
    const [a, b] = ends.map(([, , corner]) => corner);
    if ((a + 1) % 4 === b) return ["joint", ends[0][1], a];
    return (b + 1) % 4 === a ? ["joint", ends[0][1], b] : null;
  }
  const [start, end] = ["start", "end"].map((section) => vertexOf(["beam", number, section, "centre"]));
  if (start?.[0] !== "beam" || end?.[0] !== "beam" || start[2] === "end") return null; // split, or turned round
  const at = vertexOf(["beam", number, rest[0] ?? "start", "centre"]);
  return at[0] === "beam" ? ["beam", at[1], ...(rest.length ? [at[2], ...rest.slice(1)] : [])] : null;
}

export function isIndex(value, count) {
  return Number.isInteger(value) && value >= 0 && value < count;
}

function isCorner(value, count) {
  return value === "centre" || isIndex(value, count);
}
