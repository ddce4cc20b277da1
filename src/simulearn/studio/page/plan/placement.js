// Where a panel goes beside a beam so that it hides little of the plan.

const GAP = 20; // px between beam and panel
const EDGE = 8; // px between panel and the view's border

/** Return the panel's left upper corner [x, y] in pixels: beside the beam, away from the grid's middle.
 *
 * ends: the beam's ends in pixels. middle: the grid's middle in pixels. panel, view: {width, height};
 * the view's left `tools` px are taken.
 */
export function beside(ends, middle, panel, view, tools = 64) {
  const [xs, ys] = [0, 1].map((axis) => ends.map((end) => end[axis]));
  const [x, y] = [(xs[0] + xs[1]) / 2, (ys[0] + ys[1]) / 2];
  const steep = Math.abs(ys[0] - ys[1]) > Math.abs(xs[0] - xs[1]);
  // A panel at the long side of a beam keeps clear of its ends; at the other side only of its middle.
  const [wide, high] = steep ? [xs, [y]] : [[x], ys];
  const [left, top] = [x - panel.width / 2, y - panel.height / 2];
  const places = {
    below: [left, Math.max(...high) + GAP],
    above: [left, Math.min(...high) - GAP - panel.height],
    right: [Math.max(...wide) + GAP, top],
    left: [Math.min(...wide) - GAP - panel.width, top],
  };
  const upright = y < middle[1] ? ["above", "below"] : ["below", "above"];
  const level = x < middle[0] ? ["left", "right"] : ["right", "left"];
  const order = steep ? [...level, ...upright] : [...upright, ...level];
  const [most, deepest] = [view.width - EDGE - panel.width, view.height - EDGE - panel.height];
  const fits = ([px, py]) => px >= tools && py >= EDGE && px <= most && py <= deepest;
  const name = order.find((one) => fits(places[one])) ?? order[0];
  return clamped(places[name], panel, view, tools);
}

/** Return a panel's corner moved into the view. */
export function clamped([x, y], panel, view, tools = EDGE) {
  return [
    Math.max(Math.min(tools, view.width - panel.width), Math.min(x, view.width - EDGE - panel.width)),
    Math.max(EDGE, Math.min(y, view.height - EDGE - panel.height)),
  ];
}
