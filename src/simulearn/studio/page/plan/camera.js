// The camera of the plan: where millimetres lie on the screen. Screen coordinates are pixels from
// the plan's left upper corner, y downwards; the plan's own y is upwards.

export const LEAST_SCALE = 0.01; // px per mm: a drawing in the wrong unit is seen whole, too
export const MOST_SCALE = 60; // px per mm: a beam is 430 px wide
const FIT_SCALE = 6; // px per mm: a single beam is not blown up further than this when fitted

/** Return the camera that has the plan's origin in the middle of a view of `size`. */
export function firstCamera({ width, height }) {
  return { x: width / 2, y: height / 2, scale: 3 };
}

/** Return the scale by which handles and text are sized: it changes in steps of 5 %, which nobody sees.
 *
 * Each change of it makes the browser compute the style of every part anew.
 */
export function sizeScale(scale) {
  return Number((1.05 ** Math.round(Math.log(scale) / Math.log(1.05))).toPrecision(4));
}

/** Return the pixel of a point in mm. */
export function toScreen({ x, y, scale }, [px, py]) {
  return [x + scale * px, y - scale * py];
}

/** Return the point in mm at a pixel. */
export function toPlan({ x, y, scale }, [sx, sy]) {
  return [(sx - x) / scale, (y - sy) / scale];
}

/** Return the camera moved by pixels. */
export function pan(camera, [dx, dy]) {
  return { ...camera, x: camera.x + dx, y: camera.y + dy };
}

/** Return the camera zoomed by a factor; the point under the pixel stays where it is. */
export function zoomAt(camera, [sx, sy], factor) {
  const scale = Math.min(MOST_SCALE, Math.max(LEAST_SCALE, camera.scale * factor));
  const change = scale / camera.scale;
  return { x: sx + (camera.x - sx) * change, y: sy + (camera.y - sy) * change, scale };
}

/** Return the camera after two fingers moved from pixels `before` to pixels `after`. */
export function pinch(camera, before, after) {
  const middle = ([a, b]) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  const apart = ([a, b]) => Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1]));
  const from = middle(before);
  const to = middle(after);
  const zoomed = zoomAt(camera, from, apart(after) / apart(before));
  return pan(zoomed, [to[0] - from[0], to[1] - from[1]]);
}

/** Return the camera that shows the box {x: [least, most], y: [least, most]}, with pixels of margin. */
export function fit(box, { width, height }, margin) {
  const wide = Math.max(1, width - margin.left - margin.right);
  const high = Math.max(1, height - margin.top - margin.bottom);
  const scale = Math.min(
    FIT_SCALE,
    wide / Math.max(1, box.x[1] - box.x[0]),
    high / Math.max(1, box.y[1] - box.y[0]),
  );
  const used = Math.max(LEAST_SCALE, scale);
  return {
    x: margin.left + wide / 2 - (used * (box.x[0] + box.x[1])) / 2,
    y: margin.top + high / 2 + (used * (box.y[0] + box.y[1])) / 2,
    scale: used,
  };
}

/** Return whether any of the points in mm is in the view. */
export function anyVisible(camera, { width, height }, points) {
  return points.some((point) => {
    const [x, y] = toScreen(camera, point);
    return x > 0 && y > 0 && x < width && y < height;
  });
}
