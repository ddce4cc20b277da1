// What is printed on a layer, and the name of the file.

const MOST_NAME = 60; // characters

/** Return the length of what a layer (1 to n) prints, mm, by role: Map of role -> mm. */
export function lengthsOf(path, layer) {
  const lengths = new Map(path.roles.map((role) => [role, 0]));
  path.layer_of.forEach((at, b) => {
    if (at !== layer - 1) return;
    let sum = 0;
    for (let p = path.starts[b] + 1; p < path.starts[b + 1]; p += 1) {
      const [[x, y], [u, v]] = [path.points[p - 1], path.points[p]];
      sum += Math.hypot(u - x, v - y);
    }
    const role = path.roles[path.role[b]];
    lengths.set(role, lengths.get(role) + sum);
  });
  return lengths;
}

const AROUND = ["skirt", "brim"]; // what is no part of the grid

/** Return the size of what is printed, without skirt and brim: [width, depth, height] in mm. */
export function sizeOf(path) {
  const low = [Infinity, Infinity];
  const high = [-Infinity, -Infinity];
  path.role.forEach((role, b) => {
    if (AROUND.includes(path.roles[role])) return;
    for (let p = path.starts[b]; p < path.starts[b + 1]; p += 1) {
      path.points[p].forEach((value, axis) => {
        low[axis] = Math.min(low[axis], value - path.width[p] / 2);
        high[axis] = Math.max(high[axis], value + path.width[p] / 2);
      });
    }
  });
  return [high[0] - low[0], high[1] - low[1], path.layers.at(-1).z];
}

/** Return a file name made of a design's name: letters, digits, dashes. */
export function fileName(name) {
  const plain = name.normalize("NFKD").replace(/\p{Mark}/gu, "").replace(/[^A-Za-z0-9]+/g, "-");
  return plain.replace(/^-+|-+$/g, "").slice(0, MOST_NAME).toLowerCase() || "grid";
}
