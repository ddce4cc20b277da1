// The 3D view without the page around it: shows results, ghosts, overlays and prints in a container,
// from plain data, and says what the pointer is on. Used by the studio and by files that stand alone.

import { THREE } from "/libraries/three.js";
import { boxOf } from "../document/surfaces.js";
import { createAnnotations } from "./annotations.js";
import { createBody } from "./body.js";
import { createCamera } from "./camera.js";
import { createGround } from "./ground.js";
import { pick } from "./picking.js";
import { createPrint } from "./print.js";
import { createPrints } from "./prints.js";
import { createStage } from "./stage.js";
import { createSurfaces } from "./surfaces.js";
import { readTheme, watchTheme } from "./theme.js";
import { boundsOf, cornersOf, LAST } from "./topology.js";

export { canDraw } from "./stage.js";

const UNMOVED = 0.02; // frames: before it the flat sheet is not drawn beside the shape
const PRINT_VIEW = [0, 0.42]; // rad: from above, a little aslant
const CLICK = 5; // px that a press may move and still be no drag
const GROWN = 1.7; // a result this much larger or smaller than the fitted one is fitted anew
const FITTED = [0, 4, 8, 11]; // frames that are brought into view
const ROOM = { narrow: 1.28, wide: 1.45 }; // around the shape; wide where dimensions stand beside it
const FAR = 4; // times the shape's size, up to which a surface is brought into view with it
const TURN = Math.PI / 24; // of an arrow key
const ZOOM = 1.15; // of + and -

/** What keys do in the view; as in Blender where it has them. */
export const KEYS = {
  Home: "fit", f: "fit", F: "fit", 7: "top", 1: "front", 3: "side", 0: "home", 5: "projection",
};

const passive = (grid) => grid && { ...grid, actuators: [] };

/** Create a viewer in a container.
 *
 * events: onHover(part | null), onPress(part | null, event), onCamera(state), onLost(), onRestored().
 * A part is { kind, at, number } as in the skin. still() says whether motion is unwanted.
 */
export function createViewer(container, { events = {}, still = () => false } = {}) {
  let [pointer, hovering, pressed, fitted, disposed] = [null, 0, null, null, false];
  let [overlaid, gizmo, notes, kept, spread] = [null, null, [], null, null];
  let [printing, fresh, roomy, frame] = [false, true, false, LAST];
  let held = false; // whether a hand holds something: then the view stays as it is
  const shows = { ghost: true, ground: true };
  const stage = createStage(container, {
    before: drawNotes,
    onPace: (plain) => {
      for (const part of [body, ground]) part.setPlain(plain);
    },
    onLost: () => events.onLost?.(),
    onRestored: () => events.onRestored?.(),
  });
  const camera = createCamera(stage.canvas, {
    onChange: () => {
      stage.setCamera(camera?.camera ?? null);
      stage.invalidate();
      if (camera) events.onCamera?.(camera.state(), camera.isParallel);
    },
    still,
  });
  const body = createBody();
  const ghost = createBody({ opacity: 0.16, edges: 0.28, one: "lineStrong", spacing: Infinity });
  ghost.setFrame(0);
  const other = createBody({ opacity: 0, edges: 0.75, one: "target" }); // two surfaces so near would flicker
  const ground = createGround();
  const print = createPrint();
  const prints = createPrints();
  const surfaces = createSurfaces();
  const annotations = createAnnotations(container);
  const parts = [body, ghost, other, ground, print, prints, surfaces];
  ghost.group.renderOrder = 3;
  stage.scene.add(ground.group, body.group, ghost.group, other.group, print.group, prints.group, surfaces.group);
  /** Show what is to be seen now: the print, or the shape with what belongs to it. */
  const arrange = () => {
    const shape = Boolean(body.shown) && !printing;
    body.group.visible = shape;
    ground.group.visible = shape && shows.ground;
    ghost.group.visible = shape && shows.ghost && frame > UNMOVED;
    other.group.visible = shape && Boolean(overlaid);
    prints.group.visible = shape && Boolean(spread) && frame === LAST; // prints are known in the last frame only
    surfaces.group.visible = !printing;
    print.group.visible = printing;
    stage.invalidate();
  };

  function drawNotes() {
    const items = gizmo ? [...notes, ...gizmo(project)] : notes;
    if (gizmo) annotations.set(items);
    annotations.draw(project);
  }

  const vector = new THREE.Vector3();
  function project(point) {
    vector.fromArray(point).project(camera.camera);
    return {
      x: ((vector.x + 1) / 2) * stage.size.width,
      y: ((1 - vector.y) / 2) * stage.size.height,
      seen: vector.z < 1 && vector.z > -1,
    };
  }

  const raysOf = (seen, box) => (x, y) => {
    const caster = new THREE.Raycaster();
    const [across, down] = [(x - box.left) / box.width, (y - box.top) / box.height];
    caster.setFromCamera(new THREE.Vector2(2 * across - 1, 1 - 2 * down), seen);
    return { origin: caster.ray.origin.toArray(), direction: caster.ray.direction.toArray() };
  };
  const rayAt = (x, y) => raysOf(camera.camera, stage.canvas.getBoundingClientRect())(x, y);
  const partAt = ({ clientX, clientY }) => {
    if (!body.shown || printing) return null;
    const { origin, direction } = rayAt(clientX, clientY);
    return pick(body.skin, origin, direction)?.part ?? null;
  };

  const onMove = (event) => {
    if (event.buttons) return;
    pointer = event;
    hovering ||= requestAnimationFrame(() => { // trackpads send several moves for one drawing
      hovering = 0;
      if (pointer) events.onHover?.(partAt(pointer));
    });
  };
  const onLeave = () => {
    pointer = null;
    events.onHover?.(null);
  };
  const onDown = (event) => {
    pressed = event.isPrimary && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
  };
  const onUp = (event) => {
    if (!pressed || Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > CLICK) return;
    pressed = null;
    events.onPress?.(partAt(event), event);
  };
  const listeners = {
    pointermove: onMove, pointerleave: onLeave, pointerdown: onDown, pointerup: onUp,
    dblclick: () => viewer.fit(),
  };
  for (const [name, listener] of Object.entries(listeners))
    stage.canvas.addEventListener(name, listener);

  const applyTheme = () => {
    const theme = readTheme(container);
    stage.scene.background = new THREE.Color().setRGB(...theme.canvas, THREE.LinearSRGBColorSpace);
    for (const part of parts) part.setTheme(theme);
    stage.invalidate({ still: true });
  };
  const endTheme = watchTheme(() => requestAnimationFrame(() => !disposed && applyTheme()));
  const observer = new ResizeObserver(([entry]) => {
    const { width, height } = entry.contentRect;
    if (width === 0 || height === 0) return;
    stage.resize(width, height);
    body.setSize(width, height);
    camera.resize(width, height);
    if (!camera.touched && !held) viewer.fit({ view: fresh ? "home" : null, animate: false });
  });
  observer.observe(container);
  applyTheme();
  stage.setCamera(camera.camera);

  const sizeOf = ({ low, high }) => Math.hypot(...high.map((x, axis) => x - low[axis]));
  const grown = (bounds) => {
    const ratio = sizeOf(bounds) / sizeOf(fitted);
    const middle = ({ low, high }) => low.map((x, k) => (x + high[k]) / 2);
    const before = middle(fitted);
    const away = Math.hypot(...middle(bounds).map((x, k) => x - before[k]));
    return ratio > GROWN || ratio < 1 / GROWN || away > 0.5 * sizeOf(fitted);
  };

  /** Return points that are to be seen: those of the shape, and of surfaces that are not much larger. */
  const seen = () => {
    if (!body.shown) return [];
    const size = FAR * sizeOf(boundsOf(body.shown.result));
    const near = surfaces.shown.filter(({ vertices }) => sizeOf(boxOf(vertices)) < size);
    return [...cornersOf(body.shown.result, FITTED), ...near.flatMap(({ vertices }) => vertices)];
  };

  const viewer = {
    stage, camera, body, project,
    /** Hold the view still for a drag; return rayAt(x, y), which stays that of the view as it is now. */
    hold() {
      held = true;
      camera.stop();
      return raysOf(camera.camera.clone(), stage.canvas.getBoundingClientRect());
    },
    release() {
      held = false;
    },
    /** Return mm that one pixel is at a point [x, y, z]. */
    pixel: (point) => camera.pixel(new THREE.Vector3(...point)),
    /** Show a result of a grid, or nothing. The camera stays unless the size is quite another. */
    show(result, grid = null) {
      body.show(result, grid);
      viewer.overlay(null);
      if (result) {
        if (shows.ghost) ghost.show(result, passive(grid));
        ground.place(boundsOf(result, 0, 0), body.mesh);
        const bounds = boundsOf(result);
        if (!held && (!fitted || grown(bounds))) viewer.fit({ view: fresh ? "home" : null, animate: false });
      }
      arrange();
    },
    setFrame(next) {
      frame = next;
      body.setFrame(frame);
      other.setFrame(frame);
      arrange();
    },
    /** Say whether frame will follow frame. */
    setPlaying: (on) => stage.hold(on),
    setColour(by, reference = null) {
      body.setColour(by, reference);
      stage.invalidate();
    },
    setGhost(on) {
      shows.ghost = on;
      if (on && body.shown) ghost.show(body.shown.result, passive(body.shown.grid));
      arrange();
    },
    /** Leave room beside the shape when it is fitted. */
    setRoomy(on) {
      roomy = on;
      if (!camera.touched) viewer.fit();
    },
    setGround(on) {
      shows.ground = on;
      arrange();
    },
    setDim(dim) {
      body.setDim(dim);
      stage.invalidate({ still: true });
    },
    setMarks(marks) {
      body.setMarks(marks);
      stage.invalidate({ still: true });
    },
    /** Lay another result of the same grid over the shown one, translucent; null for none. */
    overlay(result) {
      overlaid = body.shown && result;
      other.show(overlaid, body.shown?.grid ?? null);
      arrange();
    },
    /** Show surfaces that the grid is to lie on; a new one is brought into view. */
    setSurfaces(list) {
      const fresh = list.some((one) => !surfaces.shown.some(({ vertices }) => vertices === one.vertices));
      surfaces.show(list);
      arrange();
      if (fresh && !held) viewer.fit({ animate: false });
    },
    /** Draw prints of the shown design (T, B, 3, 3) around its last frame; null for none. */
    setPrints(centres) {
      spread = centres;
      prints.show(centres);
      arrange();
    },
    /** Show annotations; `handles` (project -> items) are made anew for every drawing. */
    setNotes(items, handles = null) {
      notes = items;
      gizmo = handles;
      annotations.set(handles ? [...items, ...handles(project)] : items);
      stage.invalidate({ still: true });
    },
    /** Show a toolpath in place of the shape, seen from above; null brings the shape back. */
    setPrint(toolpath, bed = null) {
      const on = toolpath !== null;
      const place = JSON.stringify([bed?.low, bed?.high]);
      const moved = on && printing && place !== kept.place; // to a bed that lies elsewhere
      if (print.path !== toolpath) print.show(toolpath, bed);
      const changed = on !== printing;
      printing = on;
      arrange();
      if (!changed && !moved) return;
      if (on) {
        kept = changed ? { ...camera.state(), touched: camera.touched, place } : { ...kept, place };
        viewer.fit({ view: PRINT_VIEW, animate: false });
      } else if (kept.touched) camera.set(kept);
      else viewer.fit({ view: [kept.azimuth, kept.polar], animate: false });
    },
    setLayer(layer, travels) {
      print.setLayer(layer, travels);
      stage.invalidate();
    },
    fit(options = {}) {
      const points = printing ? print.points() : seen();
      if (points.length && stage.size.width) {
        fresh = false;
        if (!printing) fitted = boundsOf(body.shown.result);
        camera.fit(points, { margin: roomy ? ROOM.wide : ROOM.narrow, ...options });
      }
    },
    /** Do what a key of `KEYS` says, orbit by arrows, zoom by + and -; return whether it did. */
    onKey({ key, shiftKey, ctrlKey, metaKey, altKey }) {
      if (ctrlKey || metaKey || altKey) return false;
      const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
      if (arrow && shiftKey) camera.pan(40 * arrow[0], -40 * arrow[1]);
      else if (arrow) camera.orbit(TURN * arrow[0], TURN * arrow[1]);
      else if (key === "+" || key === "=") camera.zoom(ZOOM);
      else if (key === "-" || key === "_") camera.zoom(1 / ZOOM);
      else if (KEYS[key]) viewer.command(KEYS[key]);
      else return false;
      return true;
    },
    command(name) {
      if (name === "fit") viewer.fit();
      else if (name === "projection") camera.setParallel(!camera.isParallel);
      else if (camera.touched) camera.look(name);
      else viewer.fit({ view: name });
    },
    dispose() {
      disposed = true;
      endTheme();
      observer.disconnect();
      cancelAnimationFrame(hovering);
      for (const [name, listener] of Object.entries(listeners))
        stage.canvas.removeEventListener(name, listener);
      annotations.dispose();
      camera.dispose();
      for (const part of parts) part.dispose();
      stage.dispose();
    },
  };
  return viewer;
}
