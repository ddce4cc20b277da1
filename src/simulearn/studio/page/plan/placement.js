// Where a panel goes beside a beam so that it hides little of the plan.

const GAP = 20; // px between beam and panel
const EDGE = 8; // px between panel and the view's border

/** Return the panel's left upper corner [x, y] in pixels: below the beam, else above, else beside.
 *
 * ends: the beam's ends in pixels. panel, view: {width, height}; the view's left `tools` px are taken.
 */
export function beside(ends, panel, view, tools = 64) {
  const [xs, ys] = [0, 1].map((axis) => ends.map((end) => end[axis]));
  const middle = [(xs[0] + xs[1]) / 2, (ys[0] + ys[1]) / 2];
  const steep = Math.abs(ys[0] - ys[1]) > Math.abs(xs[0] - xs[1]);
  const half = [panel.width / 2, panel.height / 2];
  const below = [middle[0] - half[0], Math.max(...(steep ? [middle[1]] : ys)) + GAP];
  const above = [middle[0] - half[0], Math.min(...(steep ? [middle[1]] : ys)) - GAP - panel.height];
  const right = [Math.max(...(steep ? xs : [middle[0]])) + GAP, middle[1] - half[1]];
  const left = [Math.min(...(steep ? xs : [middle[0]])) - GAP - panel.width, middle[1] - half[1]];
  const fits = ([x, y]) =>
    x >= tools && y >= EDGE && x + panel.width <= view.width - EDGE && y + panel.height <= view.height - EDGE;
  const found = (steep ? [right, left, below, above] : [below, above, right, left]).find(fits) ?? below;
  return clamped(found, panel, view, tools);
}

/** Return a panel's corner moved into the view. */
export function clamped([x, y], panel, view, tools = EDGE) {
  return [
    Math.max(Math.min(tools, view.width - panel.width), Math.min(x, view.width - EDGE - panel.width)),
    Math.max(EDGE, Math.min(y, view.height - EDGE - panel.height)),
  ];
}
