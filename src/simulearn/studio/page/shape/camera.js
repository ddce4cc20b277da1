// The camera of a view: orbit by mouse, trackpad, touch and keys, named views, fit, perspective or
// parallel projection. It turns about a target; +z is up.

import { OrbitControls, THREE } from "/libraries/three.js";

const ANGLE = 30; // degrees, of the perspective's height
const LEAST = 20; // mm from the target
const TURN = 260; // ms of the way to a named view
const NEVER_FLAT = 1e-4; // rad from the pole, where the azimuth would be lost

/** Azimuth and polar angle (rad) of the named views: where the camera stands. */
export const VIEWS = {
  home: [-0.62, 1.06],
  front: [0, Math.PI / 2],
  side: [Math.PI / 2, Math.PI / 2],
  top: [0, NEVER_FLAT],
};

/** Create the camera of a canvas (null for none, to be placed only). onChange is called whenever it moved. */
export function createCamera(element, { onChange, still = () => false }) {
  const perspective = new THREE.PerspectiveCamera(ANGLE, 1, 1, 5000);
  const parallel = new THREE.OrthographicCamera(-1, 1, 1, -1, -5000, 5000);
  for (const camera of [perspective, parallel]) {
    camera.up.set(0, 0, 1);
    camera.position.set(-150, -200, 150); // until something is fitted
  }
  const controls = new OrbitControls(perspective, element);
  controls.enableDamping = false; // the view stops where the hand stops, and nothing is drawn after it
  controls.zoomToCursor = true;
  controls.rotateSpeed = 0.9;
  controls.zoomSpeed = 1.1;
  controls.touches = { ONE: THREE.TOUCH.ROTATE, TWO: THREE.TOUCH.DOLLY_PAN };
  controls.addEventListener("change", onChange);
  const size = { width: 1, height: 1 };
  const slope = Math.tan((ANGLE * Math.PI) / 360);
  let motion = null; // towards a named view: { from, to, begun }
  let turning = 0;

  const camera = () => controls.object;
  const state = () => {
    const offset = camera().position.clone().sub(controls.target);
    const distance = offset.length() / (camera() === parallel ? parallel.zoom : 1);
    return {
      azimuth: Math.atan2(offset.x, -offset.y),
      polar: Math.acos(Math.min(1, Math.max(-1, offset.z / offset.length()))),
      distance,
      target: controls.target.clone(),
    };
  };
  const place = ({ azimuth, polar, distance, target }) => {
    const tilt = Math.min(Math.PI - NEVER_FLAT, Math.max(NEVER_FLAT, polar));
    const direction = new THREE.Vector3(
      Math.sin(azimuth) * Math.sin(tilt), -Math.cos(azimuth) * Math.sin(tilt), Math.cos(tilt),
    );
    controls.target.copy(target);
    perspective.near = distance / 40;
    perspective.far = distance * 12;
    parallel.near = -distance * 10;
    parallel.far = distance * 12;
    const aspect = size.width / size.height;
    perspective.aspect = aspect;
    parallel.top = distance * slope;
    parallel.bottom = -parallel.top;
    parallel.right = parallel.top * aspect;
    parallel.left = -parallel.right;
    parallel.zoom = 1;
    for (const one of [perspective, parallel]) {
      one.position.copy(target).addScaledVector(direction, distance);
      one.lookAt(target);
      one.updateProjectionMatrix();
      one.updateMatrixWorld();
    }
    controls.update();
    onChange();
  };
  const step = (now) => {
    if (!motion) return;
    const t = Math.min(1, (now - motion.begun) / TURN);
    const ease = 1 - (1 - t) ** 3;
    const { from, to } = motion;
    const mix = (a, b) => a + ease * (b - a);
    place({
      azimuth: mix(from.azimuth, to.azimuth),
      polar: mix(from.polar, to.polar),
      distance: mix(from.distance, to.distance),
      target: from.target.clone().lerp(to.target, ease),
    });
    if (t < 1) turning = requestAnimationFrame(step);
    else motion = null;
  };
  const go = (to, animate = true) => {
    cancelAnimationFrame(turning);
    motion = null;
    const from = state();
    const turn = ((to.azimuth - from.azimuth + 3 * Math.PI) % (2 * Math.PI)) - Math.PI; // the short way
    if (!animate || still()) {
      place(to);
      return;
    }
    motion = { from, to: { ...to, azimuth: from.azimuth + turn }, begun: performance.now() };
    turning = requestAnimationFrame(step);
  };
  let touched = false; // whether a person moved the view since it was fitted
  controls.addEventListener("start", () => {
    motion = null;
    touched = true;
  });

  return {
    controls,
    state,
    get camera() { return camera(); },
    get touched() { return touched; },
    get isParallel() { return camera() === parallel; },
    resize(width, height) {
      Object.assign(size, { width: Math.max(1, width), height: Math.max(1, height) });
      place(state());
    },
    /** Look from a named view, or from [azimuth, polar]; the distance stays. */
    look(view, animate = true) {
      const [azimuth, polar] = VIEWS[view] ?? view;
      go({ ...(motion?.to ?? state()), azimuth, polar }, animate);
    },
    /** Bring points (a list of [x, y, z]) into view; from a named view where one is given. */
    fit(points, { view = null, animate = true, margin = 1.2 } = {}) {
      if (points.length === 0) return;
      const now = motion?.to ?? state();
      const [azimuth, polar] = view ? VIEWS[view] ?? view : [now.azimuth, now.polar];
      const back = [
        Math.sin(azimuth) * Math.sin(polar), -Math.cos(azimuth) * Math.sin(polar), Math.cos(polar),
      ];
      const right = [Math.cos(azimuth), Math.sin(azimuth), 0];
      const up = [
        -Math.sin(azimuth) * Math.cos(polar), Math.cos(azimuth) * Math.cos(polar), Math.sin(polar),
      ];
      const axes = [right, up, back];
      const seen = points.map((p) => axes.map((axis) => axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2]));
      const middle = [0, 1, 2].map((k) => {
        let [low, high] = [Infinity, -Infinity];
        for (const p of seen) [low, high] = [Math.min(low, p[k]), Math.max(high, p[k])];
        return (low + high) / 2;
      });
      const aspect = size.width / size.height;
      const depth = camera() === parallel ? 0 : 1;
      let distance = LEAST;
      for (const p of seen) {
        const across = Math.max(Math.abs(p[0] - middle[0]) / aspect, Math.abs(p[1] - middle[1]));
        distance = Math.max(distance, (margin * across) / slope + depth * (p[2] - middle[2]));
      }
      const target = new THREE.Vector3(
        ...[0, 1, 2].map((k) => middle[0] * right[k] + middle[1] * up[k] + middle[2] * back[k]),
      );
      go({ azimuth, polar, distance, target }, animate);
      touched = false;
    },
    orbit(azimuth, polar) {
      touched = true;
      const now = motion?.to ?? state();
      const tilt = Math.min(Math.PI, Math.max(0, now.polar + polar));
      go({ ...now, azimuth: now.azimuth + azimuth, polar: tilt }, false);
    },
    zoom(factor) {
      touched = true;
      const now = motion?.to ?? state();
      go({ ...now, distance: now.distance / factor }, false);
    },
    pan(x, y) {
      touched = true;
      const now = state();
      const matrix = camera().matrixWorld.elements;
      const per = (2 * now.distance * slope) / size.height;
      const move = new THREE.Vector3(
        ...[0, 1, 2].map((k) => per * (x * matrix[k] + y * matrix[4 + k])),
      );
      go({ ...now, target: now.target.add(move) }, false);
    },
    /** Return mm that one pixel is at a point. */
    pixel(point) {
      if (camera() === parallel) return (2 * parallel.top) / parallel.zoom / size.height;
      const depth = point.clone().sub(camera().position).dot(camera().getWorldDirection(new THREE.Vector3()));
      return (2 * Math.max(depth, 1e-3) * slope) / size.height;
    },
    setParallel(on) {
      const now = state();
      controls.object = on ? parallel : perspective;
      place(now);
    },
    set: (to) => go({ ...to, target: to.target.clone() }, false),
    /** Stay where the camera is on its way. */
    stop() {
      cancelAnimationFrame(turning);
      motion = null;
    },
    dispose() {
      cancelAnimationFrame(turning);
      if (element) controls.dispose();
    },
  };
}
