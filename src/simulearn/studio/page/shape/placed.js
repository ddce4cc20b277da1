// A shape where it is compared with its goals: its result turned and shifted.

const known = new WeakMap(); // result -> { key, placed }

/** Return a result after a motion { turn: rows of a rotation, shift: mm }; the last one is remembered. */
export function placedResult(result, place) {
  const key = JSON.stringify(place);
  if (known.get(result)?.key === key) return known.get(result).placed;
  const move = mover(place);
  const placed = {
    ...result, joints: moved(result.joints, move), beams: moved(result.beams, move),
    collisions: result.collisions?.map((one) => ({ ...one, place: move(...one.place) })),
  };
  known.set(result, { key, placed });
  return placed;
}

function mover({ turn, shift }) {
  return (x, y, z) => turn.map((row, k) => row[0] * x + row[1] * y + row[2] * z + shift[k]);
}

function moved(numbers, move) {
  const next = new Float32Array(numbers.length);
  for (let k = 0; k < numbers.length; k += 3) next.set(move(numbers[k], numbers[k + 1], numbers[k + 2]), k);
  return next;
}
