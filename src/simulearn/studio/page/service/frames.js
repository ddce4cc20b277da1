// The binary answer of /api/simulate: what qualifies each result, and views of its numbers.

export const MEDIA_TYPE = "application/vnd.simulearn.frames";
export const FRAMES = 12;

/** Parse a message into a list of results.
 *
 * A result has the header's fields (ok, stable, bound_mm, warnings, ...); one that is `ok` has the
 * views `joints` (12, J, 8, 3), `beams` (12, B, 3, 4, 3) and, where the engine has stresses,
 * `mises` (12, B, 4, 4), all Float32Array; where prints were asked for, `prints` (T, B, 3, 3), the
 * centres of the beams' sections in each. Nothing is copied.
 */
export function parseFrames(buffer) {
  const bytes = new DataView(buffer);
  const magic = String.fromCharCode(...new Uint8Array(buffer, 0, 4));
  if (magic !== "SLF1") throw new Error("The server's answer is not a message of frames.");
  const length = bytes.getUint32(4, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
  const numbers = new Float32Array(buffer, 8 + length);
  return header.results.map((entry) => {
    const result = { ...entry };
    delete result.arrays;
    for (const [name, { start, shape }] of Object.entries(entry.arrays ?? {})) {
      const size = shape.reduce((product, n) => product * n, 1);
      result[name] = numbers.subarray(start, start + size);
    }
    if (entry.ok) {
      result.jointCount = entry.arrays.joints.shape[1];
      result.beamCount = entry.arrays.beams.shape[1];
    }
    return result;
  });
}
