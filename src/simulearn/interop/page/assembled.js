// An assembly that plays without a server: its parts in their order, and what is to be known of them.

import { GLTFLoader, OrbitControls, THREE } from "/libraries/three.js";
import { canDraw } from "/page/shape/stage.js";
import { view } from "/page/store.js";
import { language } from "./browser.js";
import { t } from "./text.js";
import { unpacked } from "./unpack.js";

const { document } = globalThis;
const STILL = globalThis.matchMedia("(prefers-reduced-motion: reduce)").matches;
const AWAY = 1.08; // times the distance from which the box around all parts fills the view
const SEEN = 9; // moments whose parts are all brought into view

/** Return an element with attributes and contents. */
function element(name, attributes = {}, ...contents) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...contents);
  return made;
}

/** Return the view of a glTF scene: show(seconds) draws it as it is then. */
function viewed(place, { scene, animations: [clip] }, towards) {
  const renderer = new THREE.WebGLRenderer({ antialias: true });
  const world = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(35, 1, 0.001, 100);
  const controls = new OrbitControls(camera, renderer.domElement);
  const mixer = new THREE.AnimationMixer(scene);
  mixer.clipAction(clip).play();
  const key = new THREE.DirectionalLight(0xffffff, 2.2);
  key.position.set(-0.5, 1, 0.6);
  const lamps = new THREE.Group().add(key);
  world.add(scene, lamps, new THREE.HemisphereLight(0xffffff, 0x8d8d8d, 1.6));
  place.append(renderer.domElement);

  const draw = () => {
    world.background = new THREE.Color(globalThis.getComputedStyle(place).backgroundColor);
    lamps.quaternion.copy(camera.quaternion);
    renderer.render(world, camera);
  };
  const show = (seconds) => {
    mixer.setTime(Math.min(seconds, clip.duration - 1e-4)); // at its end it would begin again
    draw();
  };
  const box = new THREE.Box3();
  for (let k = 0; k < SEEN; k += 1) {
    mixer.setTime((k / SEEN) * clip.duration);
    box.expandByObject(scene, true);
  }
  scene.traverse((mesh) => { mesh.frustumCulled = false; }); // it moves out of the box that it begins in
  const middle = box.getCenter(new THREE.Vector3());
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => new THREE.Vector3(
    box[k & 1 ? "max" : "min"].x, box[k & 2 ? "max" : "min"].y, box[k & 4 ? "max" : "min"].z,
  ).sub(middle));
  controls.target.copy(middle);
  let placed = false;
  const fit = () => {
    const { clientWidth: width, clientHeight: height } = place;
    renderer.setPixelRatio(globalThis.devicePixelRatio);
    renderer.setSize(width, height);
    camera.aspect = width / height;
    const from = placed ? camera.position.clone().sub(middle) : new THREE.Vector3(...towards);
    placed = true;
    const looking = new THREE.Matrix4().lookAt(from, new THREE.Vector3(), camera.up).invert();
    const half = Math.tan(((camera.fov / 2) * Math.PI) / 180);
    const far = AWAY * Math.max(...corners.map((corner) => {
      const { x, y, z } = corner.clone().applyMatrix4(looking);
      return Math.max(Math.abs(x) / (half * camera.aspect), Math.abs(y) / half) + z;
    }));
    camera.position.copy(middle).addScaledVector(from.normalize(), far);
    [camera.near, camera.far] = [far / 100, far * 10];
    camera.updateProjectionMatrix();
    controls.update();
    draw();
  };
  fit();
  controls.addEventListener("change", draw);
  new ResizeObserver(fit).observe(place);
  globalThis.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => setTimeout(draw));
  return { show, duration: clip.duration };
}

/** Return the row of controls that plays a view. */
function controls({ show, duration }, { steps, pause }) {
  const button = element("button", { type: "button", class: "download" });
  const slider = element("input", {
    type: "range", min: 0, max: duration, step: 0.01, "aria-label": t("share.moment"),
  });
  const words = element("output", { class: "step" });
  let [time, playing, last] = [0, false, 0];

  const set = (next) => {
    time = next;
    slider.value = time;
    const at = time - pause;
    const k = Math.max(0, steps.findLastIndex(({ begins }) => begins < at));
    words.textContent = t("share.step", { number: k + 1, count: steps.length, name: steps[k].name });
    slider.setAttribute("aria-valuetext", words.textContent);
    show(time);
  };
  const tick = (now) => {
    if (!playing) return;
    set((time + (now - last) / 1000) % duration);
    last = now;
    requestAnimationFrame(tick);
  };
  const play = (on) => {
    playing = on;
    last = performance.now();
    button.textContent = t(on ? "shape.pause" : "shape.play");
    if (on) requestAnimationFrame(tick);
  };
  button.addEventListener("click", () => play(!playing));
  slider.addEventListener("input", () => {
    play(false);
    set(Number(slider.value));
  });
  set(STILL ? duration : 0);
  play(!STILL);
  return element("div", { class: "plays" }, button, slider, words);
}

/** Return what is to be known: collisions, warnings, parts, the engine. */
function details({ parts, collisions, warnings, engine }) {
  const list = (title, lines, name = "") => {
    if (!lines.length) return [];
    const items = lines.map((line) => element("li", {}, line));
    return [element("section", { class: name }, element("h2", {}, title), element("ul", { lang: "en" }, ...items))];
  };
  const key = `share.engine_${engine}`;
  return element("aside", { class: "details", tabindex: 0, "aria-label": t("share.result") },
    ...list(t("share.collisions"), collisions, "warnings"),
    ...list(t("share.warnings"), warnings, "warnings"),
    ...list(t("share.parts"), parts),
    element("section", {}, element("dl", {}, element("dt", {}, t("share.engine")),
      element("dd", {}, t(key) === key ? engine : t(key)))),
    element("p", { class: "made" }, t("share.made", {
      version: document.querySelector("meta[name=generator]").content.split(" ")[1],
    })));
}

async function start() {
  view.language = language();
  document.documentElement.lang = view.language;
  const facts = JSON.parse(document.querySelector("#simulearn-result").textContent);
  const main = document.querySelector("main");
  const picture = document.querySelector("#picture");
  const place = element("div", { class: "view" });
  const left = element("div", { class: "place" }, place);
  main.className = "page";
  main.replaceChildren(left, details(facts));
  if (!canDraw()) {
    left.replaceChildren(element("figure", { class: "still" }, picture, element("figcaption", {}, t("share.noWebgl"))));
    return;
  }
  const data = await (await unpacked("simulearn-frames")).arrayBuffer();
  const scene = await new GLTFLoader().parseAsync(data, "");
  left.append(controls(viewed(place, scene, facts.towards), facts));
}

start();
