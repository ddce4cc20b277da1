// A canvas with a scene that is drawn only when something changed, and at a lower resolution while
// it moves where the machine draws in software.

import { THREE } from "/libraries/three.js";

const FINEST = 2; // pixels of the canvas for one of the page, at most
const SLOW = 26; // ms between drawings in a row: longer means that this machine is slow
const RUN = 5; // drawings in a row that are looked at
const REST = 160; // ms without a drawing after which the full resolution comes back
const STEPS = [1, 0.8, 0.6]; // of the resolution while moving

/** Whether three.js can draw here at all. */
export function canDraw() {
  const canvas = globalThis.document.createElement("canvas");
  return Boolean(canvas.getContext("webgl2"));
}

/** Create a stage in a container. before() is called ahead of every drawing. */
export function createStage(container, { before, onLost, onRestored }) {
  const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: false, powerPreference: "low-power" });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // colours are written as the style sheet has them
  THREE.ColorManagement.enabled = false;
  renderer.sortObjects = true;
  const canvas = renderer.domElement;
  container.append(canvas);
  const scene = new THREE.Scene();
  const size = { width: 0, height: 0 };
  const intervals = [];
  let [camera, pending, last, level, rest, lost] = [null, 0, 0, 0, 0, false];
  let drawn = 0;

  const resolution = () => Math.min(globalThis.devicePixelRatio || 1, FINEST) * STEPS[level];
  const apply = () => {
    renderer.setPixelRatio(resolution());
    renderer.setSize(size.width, size.height, false);
  };
  const settle = () => {
    intervals.length = 0;
    if (level === 0) return;
    level = 0;
    apply();
    draw();
  };
  const pace = (now) => {
    const interval = now - last;
    last = now;
    if (interval > 4 * SLOW) return; // the first after a pause
    intervals.push(interval);
    if (intervals.length < RUN) return;
    const mean = intervals.reduce((a, b) => a + b, 0) / intervals.length;
    intervals.length = 0;
    if (mean > SLOW && level < STEPS.length - 1) {
      level += 1;
      apply();
    }
  };
  const draw = () => {
    if (lost || !camera || size.width === 0 || size.height === 0) return;
    before();
    renderer.render(scene, camera);
    drawn += 1;
  };
  const frame = (now) => {
    pending = 0;
    pace(now);
    draw();
    clearTimeout(rest);
    rest = setTimeout(settle, REST);
  };
  const invalidate = () => {
    if (!pending) pending = requestAnimationFrame(frame);
  };
  const onContextLost = (event) => {
    event.preventDefault(); // so that the browser may restore it
    lost = true;
    onLost();
  };
  const onContextRestored = () => {
    lost = false;
    onRestored();
    invalidate();
  };
  canvas.addEventListener("webglcontextlost", onContextLost);
  canvas.addEventListener("webglcontextrestored", onContextRestored);

  return {
    renderer, canvas, scene, size, invalidate,
    get drawn() { return drawn; },
    setCamera(next) { camera = next; },
    resize(width, height) {
      Object.assign(size, { width, height });
      apply();
      draw(); // at once: a canvas is cleared when its size changes
    },
    dispose() {
      cancelAnimationFrame(pending);
      clearTimeout(rest);
      canvas.removeEventListener("webglcontextlost", onContextLost);
      canvas.removeEventListener("webglcontextrestored", onContextRestored);
      renderer.dispose();
      renderer.forceContextLoss();
      canvas.remove();
    },
  };
}
