// Which part of the plan the keyboard goes to from another: the nearest in a direction.

const DIRECTIONS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const ASIDE = 2.5; // how much more a mm to the side counts than one ahead

/** Return the unit vector of an arrow key, or null. */
export function direction(key) {
  return DIRECTIONS[key] ?? null;
}

/** Return where a part is: a joint's place, a beam's middle. */
export function placeOf(grid, part) {
  if (part?.joint !== undefined) return grid.joints[part.joint] ?? null;
  const beam = grid.beams[part?.beam];
  if (!beam) return null;
  const [p, q] = beam.map((k) => grid.joints[k]);
  return [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
}

/** Return the nearest part in the direction of an arrow key, or the part itself where there is none. */
export function neighbour(grid, part, key) {
  const from = placeOf(grid, part);
  const [ux, uy] = DIRECTIONS[key];
  if (!from) return firstPart(grid);
  let best = part;
  let least = Infinity;
  for (const other of allParts(grid)) {
    const [x, y] = placeOf(grid, other);
    const ahead = (x - from[0]) * ux + (y - from[1]) * uy;
    const aside = Math.abs((x - from[0]) * uy - (y - from[1]) * ux);
    const cost = ahead + ASIDE * aside;
    if (ahead > 1e-6 && aside <= 2 * ahead && cost < least) [best, least] = [other, cost];
  }
  return best;
}

/** Return the part that the Tab key reaches: the one that had the focus, else the first. */
export function tabStop(grid, part) {
  return placeOf(grid, part) ? part : firstPart(grid);
}

function firstPart(grid) {
  if (grid.joints.length) return { joint: 0 };
  return null;
}

function allParts(grid) {
  return [...grid.joints.map((_, joint) => ({ joint })), ...grid.beams.map((_, beam) => ({ beam }))];
}
