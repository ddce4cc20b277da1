// Which parts of a result meet: joints and beams by their index in the result, with their numbers in
// the document, ratios and free sides. Plain data, without three.js.

export const FRAMES = 12;
export const LAST = FRAMES - 1;

/** Return what a result's numbers belong to: {joints, beams} as the skin needs them.
 *
 * joints: [{ number, fixed, free: sides 0 to 3 that meet no beam }]; beams: [{ number, ends, ratio,
 * length in mm }]. Without a grid (a picture of a result alone) there are no actuators.
 */
export function topologyOf(result, grid = null) {
  const jointNumbers = result.joint_numbers ?? [...Array(result.jointCount).keys()];
  const beamNumbers = result.beam_numbers ?? [...Array(result.beamCount).keys()];
  const indexOf = new Map(jointNumbers.map((number, index) => [number, index]));
  const beams = beamNumbers.map((number, b) => ({
    number,
    ends: grid ? grid.beams[number].map((k) => indexOf.get(k)) : nearestJoints(result, b),
    ratio: grid?.actuators[number] ?? 0,
    length: Math.hypot(...sectionCentre(result, b, 2).map((x, a) => x - sectionCentre(result, b, 0)[a])),
  }));
  const free = jointNumbers.map(() => [0, 1, 2, 3]);
  beams.forEach(({ ends }, b) => ends.forEach((j, e) => {
    const taken = nearestSide(result, j, sectionCentre(result, b, 2 * e));
    free[j] = free[j].filter((side) => side !== taken);
  }));
  const joints = jointNumbers.map((number, j) => ({ number, fixed: number === grid?.fixed, free: free[j] }));
  return { joints, beams };
}

/** Return the centre of a section (0 start, 1 middle, 2 end) of a beam in a frame. */
export function sectionCentre(result, beam, section, frame = 0) {
  return meanOf(result.beams, ((frame * result.beamCount + beam) * 3 + section) * 12, 4);
}

/** Return the centre of a joint in a frame. */
export function jointCentre(result, joint, frame = 0) {
  return meanOf(result.joints, (frame * result.jointCount + joint) * 24, 8);
}

/** Return the centre of a joint, or of the middle of a beam, at a frame that may lie between two. */
export function centreAt(result, kind, index, frame) {
  const { before, after, t } = between(frame);
  const at = (k) => (kind === "joint" ? jointCentre(result, index, k) : sectionCentre(result, index, 1, k));
  const [a, b] = [at(before), at(after)];
  return a.map((x, axis) => x + t * (b[axis] - x));
}

/** Return {low, high}, corners of the box around the joints' and sections' corners of frames. */
export function boundsOf(result, first = 0, last = LAST) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const [numbers, size] of cornerArrays(result)) {
    for (let k = first * size; k < (last + 1) * size; k += 1) {
      const axis = k % 3;
      if (numbers[k] < low[axis]) low[axis] = numbers[k];
      if (numbers[k] > high[axis]) high[axis] = numbers[k];
    }
  }
  return { low, high };
}

/** Return the corners [x, y, z] of all joints and sections in some frames. */
export function cornersOf(result, frames) {
  const points = [];
  for (const [numbers, size] of cornerArrays(result))
    for (const frame of frames)
      for (let k = frame * size; k < (frame + 1) * size; k += 3)
        points.push([numbers[k], numbers[k + 1], numbers[k + 2]]);
  return points;
}

/** Return {before, after, t}: the two frames around a fractional one and how far it is between them. */
export function between(frame) {
  const at = Math.min(LAST, Math.max(0, frame));
  const before = Math.min(LAST - 1, Math.floor(at));
  return { before, after: before + 1, t: at - before };
}

/** Write `count` numbers of the frames around `frame` into `into`: those from `offset` in a frame on. */
export function blend(numbers, size, offset, count, { before, after, t }, into) {
  const a = before * size + offset;
  const b = after * size + offset;
  for (let k = 0; k < count; k += 1) into[k] = numbers[a + k] + t * (numbers[b + k] - numbers[a + k]);
}

/** Return the numbers of joints and of beams, each with how many a frame has. */
function cornerArrays(result) {
  return [[result.joints, result.jointCount * 24], [result.beams, result.beamCount * 36]];
}

function meanOf(numbers, start, count) {
  const point = [0, 0, 0];
  for (let k = 0; k < 3 * count; k += 1) point[k % 3] += numbers[start + k] / count;
  return point;
}

function nearestSide(result, joint, point) {
  const start = joint * 24;
  let [best, least] = [0, Infinity];
  for (let side = 0; side < 4; side += 1) {
    const next = (side + 1) % 4;
    let square = 0;
    for (let axis = 0; axis < 3; axis += 1) {
      let sum = 0;
      for (const corner of [side, next, side + 4, next + 4]) sum += result.joints[start + corner * 3 + axis];
      square += (sum / 4 - point[axis]) ** 2;
    }
    if (square < least) [best, least] = [side, square];
  }
  return best;
}

function nearestJoints(result, beam) {
  return [0, 2].map((section) => {
    const end = sectionCentre(result, beam, section);
    let [best, least] = [0, Infinity];
    for (let j = 0; j < result.jointCount; j += 1) {
      const distance = Math.hypot(...jointCentre(result, j).map((x, axis) => x - end[axis]));
      if (distance < least) [best, least] = [j, distance];
    }
    return best;
  });
}
