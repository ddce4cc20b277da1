// Which joints and beams are connected, and which bear something: as in grid/cleaning.py.

/** Return the sets {joints, beams} that stay when dangling beams are taken off, again and again. */
export function lasting({ joints, beams }) {
  const valence = joints.map(() => 0);
  for (const ends of beams) for (const k of ends) valence[k] += 1;
  let left = [...beams.keys()];
  for (let before = -1; before !== left.length; ) {
    before = left.length;
    left = left.filter((b) => {
      const stays = beams[b].every((k) => valence[k] > 1);
      if (!stays) for (const k of beams[b]) valence[k] -= 1;
      return stays;
    });
  }
  return { joints: new Set(left.flatMap((b) => beams[b])), beams: new Set(left) };
}

/** Return for each joint the joint that stands for all those that beams connect with it. */
export function partsOf({ joints, beams }) {
  const parent = [...joints.keys()];
  const root = (k) => {
    while (parent[k] !== k) {
      parent[k] = parent[parent[k]];
      k = parent[k];
    }
    return k;
  };
  for (const [i, j] of beams) parent[root(j)] = root(i);
  return parent.map(root);
}
