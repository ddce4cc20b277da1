// A result without a server: two beams in a row along x, bent up by a circle, actuator on the first.

const [HALF_WIDTH, HALF_THICKNESS, LENGTH] = [3.6, 2, 50];
export const GRID = {
  schema: "simulearn.grid/1", joints: [[-57.2, 0], [0, 0], [57.2, 0]], beams: [[0, 1], [1, 2]],
  actuators: [-0.5, 0], fixed: 1, material: "pla-hot-water",
};

/** Return a result whose frame f is bent with the curvature f / 11 / radius, and stressed by 10 f. */
export function bentResult({ radius = 60, frames = 12 } = {}) {
  const place = (f, [x, y, z]) => {
    if (f === 0) return [x, y, z];
    const r = (radius * 11) / f;
    return [(r - z) * Math.sin(x / r), y, r - (r - z) * Math.cos(x / r)];
  };
  const [joints, beams] = [[], []];
  const w = HALF_WIDTH;
  for (let f = 0; f < frames; f += 1) {
    for (const [cx, cy] of GRID.joints) for (const z of [-HALF_THICKNESS, HALF_THICKNESS])
      for (const [x, y] of [[w, w], [-w, w], [-w, -w], [w, -w]])
        joints.push(...place(f, [cx + x, cy + y, z]));
    for (const start of [-57.2 + w, w]) for (const t of [0, 0.5, 1])
      for (const [y, z] of [[-w, -2], [w, -2], [-w, 2], [w, 2]])
        beams.push(...place(f, [start + t * LENGTH, y, z]));
  }
  const stress = (_, k) => 10 * Math.floor(k / 32) + Math.floor((k % 16) / 4); // frame, section
  const mises = Array.from({ length: frames * 2 * 16 }, stress);
  return {
    ok: true, jointCount: 3, beamCount: 2, joint_numbers: [0, 1, 2], beam_numbers: [0, 1],
    joints: Float32Array.from(joints), beams: Float32Array.from(beams), mises: Float32Array.from(mises),
  };
}
