// Small pictures of results, for cards: all are drawn one after another on one canvas that nobody sees.

import { THREE } from "/libraries/three.js";
import { createBody } from "./body.js";
import { createCamera, VIEWS } from "./camera.js";
import { readTheme } from "./theme.js";
import { cornersOf, LAST } from "./topology.js";

const FINEST = 2; // pixels of the picture for one of the page, at most
const IDLE = 20000; // ms without a picture after which the canvas is given back

let studio = null; // { renderer, scene, camera, body } of all pictures
let queue = Promise.resolve();
let idle = 0;

/** Return a picture of the last frame of a result as a data URL (PNG), in the page's theme.
 *
 * Where the result has its `grid`, its actuators are coloured. frame: another moment than the last.
 */
export function thumbnail(result, { width = 160, height = 100, grid = result.grid, frame = LAST } = {}) {
  const picture = queue.then(() => draw(result, grid ?? null, width, height, frame));
  queue = picture.then(rest, rest);
  return picture;
}

function rest() {
  clearTimeout(idle);
  idle = setTimeout(dispose, IDLE);
  return new Promise((resolve) => { setTimeout(resolve, 0); }); // between two pictures the page answers
}

function draw(result, grid, width, height, frame) {
  studio ??= open();
  const { renderer, scene, camera, body } = studio;
  const theme = readTheme();
  body.setTheme(theme);
  body.setFrame(frame);
  body.show(result, grid);
  renderer.setPixelRatio(Math.min(globalThis.devicePixelRatio || 1, FINEST));
  renderer.setSize(width, height, false);
  camera.resize(width, height);
  camera.fit(cornersOf(result, [Math.round(frame)]), { view: VIEWS.home, animate: false, margin: 1.12 });
  renderer.render(scene, camera.camera);
  return renderer.domElement.toDataURL("image/png");
}

function open() {
  const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.setClearColor(0x000000, 0);
  const scene = new THREE.Scene();
  const body = createBody();
  scene.add(body.group);
  const camera = createCamera(null, { onChange: () => {} });
  return { renderer, scene, body, camera };
}

function dispose() {
  if (!studio) return;
  studio.camera.dispose();
  studio.body.dispose();
  studio.renderer.dispose();
  studio.renderer.forceContextLoss();
  studio = null;
}
