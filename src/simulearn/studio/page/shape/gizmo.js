// Handles that move a point along an axis or in a plane: their shapes and the geometry of a drag.

export const LENGTH = 74; // px of an axis
const NEAR = 0.22; // of the length, where a plane's handle begins
const FAR = 0.46; // and ends
const FLAT = 0.16; // an axis shorter than this part of its length points at the viewer: no handle

const AXES = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const NAMES = ["x", "y", "z"];

/** Return the handles at a point as annotation items; size: mm of the axes; project as in `draw`. */
export function gizmoItems(point, size, project, { onPress, name, active = null }) {
  const along = (axis, t) => point.map((x, k) => x + t * size * AXES[axis][k]);
  const origin = project(point);
  const planes = [];
  for (let normal = 0; normal < 3; normal += 1) {
    const [a, b] = [(normal + 1) % 3, (normal + 2) % 3];
    const corner = (s, t) => point.map((x, k) => x + size * (s * AXES[a][k] + t * AXES[b][k]));
    const points = [corner(NEAR, NEAR), corner(FAR, NEAR), corner(FAR, FAR), corner(NEAR, FAR)];
    if (area(points.map(project)) < 30) continue; // px2: seen edge-on
    const id = `plane-${NAMES[normal]}`;
    planes.push({
      id, kind: "polygon", points, className: `note-handle ${NAMES[normal]} ${active === id ? "active" : ""}`,
      name: name(NAMES[a] + NAMES[b]), tabindex: -1,
      onPress: (event) => onPress(event, { id, normal: AXES[normal] }),
    });
  }
  const items = [];
  for (let axis = 0; axis < 3; axis += 1) {
    const end = project(along(axis, 1));
    if (Math.hypot(end.x - origin.x, end.y - origin.y) < FLAT * LENGTH) continue;
    const id = `axis-${NAMES[axis]}`;
    const className = `note-handle ${NAMES[axis]} ${active === id ? "active" : ""}`;
    const press = {
      name: name(NAMES[axis]), tabindex: -1, onPress: (event) => onPress(event, { id, axis: AXES[axis] }),
    };
    items.push(
      { id, kind: "line", a: along(axis, 0.12), b: along(axis, 1), className, ...press },
      { id: `${id}-tip`, kind: "dot", at: along(axis, 1), className, ...press },
      { id: `${id}-name`, kind: "text", at: along(axis, 1.2), text: NAMES[axis], className },
    );
  }
  return [...items, ...planes]; // the planes over the axes that cross them
}

/** Return where a drag has moved a point to: `ray` now and at its begin are { origin, direction }. */
export function dragged(point, handle, begin, now) {
  const place = handle.axis ? onAxis : onPlane;
  const a = place(point, handle.axis ?? handle.normal, begin);
  const b = place(point, handle.axis ?? handle.normal, now);
  if (!a || !b) return point;
  return point.map((x, k) => x + b[k] - a[k]);
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => a.map((x, k) => x - b[k]);

/** Return the point of the line through `point` along `axis` that is nearest to a ray. */
function onAxis(point, axis, { origin, direction }) {
  const away = minus(point, origin);
  const b = dot(axis, direction);
  const c = dot(direction, direction);
  const below = c - b * b;
  if (below < 1e-9 * c) return null;
  const t = (b * dot(direction, away) - c * dot(axis, away)) / below;
  return point.map((x, k) => x + t * axis[k]);
}

function onPlane(point, normal, { origin, direction }) {
  const slope = dot(normal, direction);
  if (Math.abs(slope) < 1e-6) return null;
  const t = dot(normal, minus(point, origin)) / slope;
  return origin.map((x, k) => x + t * direction[k]);
}

function area(places) {
  let twice = 0;
  places.forEach((p, k) => {
    const q = places[(k + 1) % places.length];
    twice += p.x * q.y - q.x * p.y;
  });
  return Math.abs(twice) / 2;
}
