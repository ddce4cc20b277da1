// A canvas with a scene that is drawn only when something changed. Where the machine draws in software,
// motion is drawn coarser and without what is dear; a moment later, at rest, everything finely.

import { THREE } from "/libraries/three.js";

const FINEST = 2; // pixels of the canvas for one of the page, at most
const MOST_PIXELS = 3e6; // of a canvas at rest
const SLOW = 27; // ms between drawings in a row: longer means that this machine is slow
const FAST = 17; // ms: shorter means that it could draw more finely
const RUN = 4; // drawings in a row that are looked at
const PAUSE = 600; // ms between two drawings that are not in a row
const REST = 180; // ms without motion after which all is drawn finely,
const RESTS = 4; // and at least this many times the time between two drawings
const STEPS = [1, 0.8, 0.64, 0.5]; // of the resolution in motion
const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;

/** Whether three.js can draw here at all. */
export function canDraw() {
  const gl = globalThis.document.createElement("canvas").getContext("webgl2");
  gl?.getExtension("WEBGL_lose_context")?.loseContext(); // a browser has few
  return Boolean(gl);
}

/** Whether this browser draws without a graphics processor. */
function isSoftware() {
  const gl = globalThis.document.createElement("canvas").getContext("webgl2");
  if (!gl) return false;
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return SOFTWARE.test(name);
}

/** Create a stage in a container.
 *
 * before() is called ahead of every drawing; onPace(plain) when motion is to be drawn plainly or not.
 */
export function createStage(container, { before, onPace, onLost, onRestored }) {
  const software = isSoftware();
  // Smooth edges by several samples cost most in software, in motion too; twice the pixels at rest do not.
  const canvas = globalThis.document.createElement("canvas");
  const context = canvas.getContext("webgl2", { // without alpha: the page behind need not be mixed in
    alpha: false, antialias: !software, stencil: false, powerPreference: "low-power",
  });
  const renderer = new THREE.WebGLRenderer({ canvas, context });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // colours are written as the style sheet has them
  container.append(canvas);
  const scene = new THREE.Scene();
  const size = { width: 0, height: 0 };
  const intervals = [];
  let [camera, pending, last, level, rest] = [null, 0, 0, 0, 0];
  let [moving, lost, drawn, applied, gap] = [false, false, 0, "", 0];
  let held = false; // whether motion goes on although nothing has changed for a moment

  const resolution = () => {
    const screen = Math.min(globalThis.devicePixelRatio || 1, FINEST);
    if (moving) return screen * STEPS[level];
    const most = Math.sqrt(MOST_PIXELS / (size.width * size.height));
    return software ? Math.max(screen, Math.min(FINEST, most)) : screen;
  };
  const apply = () => {
    const ratio = resolution();
    const next = `${size.width} ${size.height} ${ratio}`;
    if (next === applied) return;
    applied = next;
    renderer.setPixelRatio(ratio);
    renderer.setSize(size.width, size.height, false);
  };
  const draw = () => {
    if (lost || !camera || size.width === 0 || size.height === 0) return;
    apply();
    onPace(moving && (software || level > 0));
    before();
    renderer.render(scene, camera);
    drawn += 1;
  };
  const settle = () => {
    if (held) {
      rest = setTimeout(settle, REST);
      return;
    }
    intervals.length = 0;
    moving = false;
    draw();
  };
  const pace = (now) => {
    const interval = now - last;
    last = now;
    gap = Math.min(interval, PAUSE);
    if (!moving || interval > PAUSE) return;
    intervals.push(interval);
    if (intervals.length < RUN) return;
    const mean = intervals.reduce((a, b) => a + b, 0) / intervals.length;
    intervals.length = 0;
    if (mean > SLOW) level = Math.min(STEPS.length - 1, level + 1);
    else if (mean < FAST && level > 0) level -= 1;
  };
  const frame = (now) => {
    pending = 0;
    pace(now);
    draw();
    if (!moving) return;
    clearTimeout(rest);
    rest = setTimeout(settle, Math.max(REST, RESTS * gap));
  };
  /** Draw soon; `still` changes (marks, texts) are drawn as finely as what is there. */
  const invalidate = ({ still = false } = {}) => {
    moving ||= !still;
    pending ||= requestAnimationFrame(frame);
  };
  const onContextLost = (event) => {
    event.preventDefault(); // so that the browser may restore it
    lost = true;
    onLost();
  };
  const onContextRestored = () => {
    lost = false;
    onRestored();
    invalidate({ still: true });
  };
  canvas.addEventListener("webglcontextlost", onContextLost);
  canvas.addEventListener("webglcontextrestored", onContextRestored);

  return {
    renderer, canvas, scene, size, invalidate, software,
    get drawn() { return drawn; },
    hold(on) { held = on; },
    setCamera(next) { camera = next; },
    resize(width, height) {
      Object.assign(size, { width, height });
      moving = true;
      draw(); // at once: a canvas is cleared when its size changes
      clearTimeout(rest);
      rest = setTimeout(settle, REST);
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
