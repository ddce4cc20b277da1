"""GLB that morphs, played by the loader of three.js in Chromium."""

import bent
import numpy as np
import pytest
from PIL import Image

import browsing
from simulearn.interop import write_morph
from simulearn.interop.libraries import libraries

PAGE = """<!doctype html><meta charset="utf-8"><body style="margin:0">
<script type="module">
import { GLTFLoader, THREE } from "/three.js";
const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(800, 600);
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color("white");
scene.add(new THREE.HemisphereLight("white", "grey", 3));
const camera = new THREE.PerspectiveCamera(35, 4 / 3, 0.01, 10);
camera.position.set(0.15, 0.2, 0.3);
camera.lookAt(0, 0, 0);
const gltf = await new GLTFLoader().loadAsync("/a.glb");
scene.add(gltf.scene);
const mixer = new THREE.AnimationMixer(gltf.scene);
gltf.animations.forEach((clip) => mixer.clipAction(clip).play());
window.duration = gltf.animations[0].duration;
window.at = (time) => {
  mixer.setTime(time);
  renderer.render(scene, camera);
  const places = [], place = new THREE.Vector3();
  gltf.scene.traverse((mesh) => {
    for (let k = 0; mesh.isMesh && k < mesh.geometry.attributes.position.count; k++) {
      places.push(mesh.getVertexPosition(k, place).toArray());
    }
  });
  return places;
};
window.ready = true;
</script>"""


@pytest.fixture
def page():
    if browsing.chromium_path() is None:
        pytest.skip("chromium is not installed")
    with browsing.chromium() as browser:
        yield browser.new_page(viewport={"width": 800, "height": 600})


def test_a_viewer_plays_it(tmp_path, page):
    result = bent.result(bent.kinds()["honeycomb"])
    path = tmp_path / "a.morph.glb"
    write_morph(result, path)
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.route("**/*", lambda route: route.fulfill(body=PAGE, content_type="text/html"))
    page.route("**/a.glb", lambda route: route.fulfill(body=path.read_bytes()))
    three = libraries()["three.js"]
    page.route(
        "**/three.js", lambda route: route.fulfill(path=three, content_type="text/javascript")
    )
    page.goto("http://viewer.test/")
    page.wait_for_function("window.ready")
    shares = []
    for share in (0.0, 0.4, 0.999):
        places = 1000 * np.array(page.evaluate(f"at({share} * duration)"))
        seen = places[:, [0, 2, 1]] * [1, -1, 1]
        moment = (share * page.evaluate("duration") - 1.4) / 0.18
        before = min(int(max(moment, 0)), 10)
        part = min(max(moment - before, 0), 1)
        joints = (1 - part) * result.joints[before] + part * result.joints[before + 1]
        away = np.linalg.norm(joints.reshape(-1, 1, 3) - seen, axis=2).min(axis=1)
        assert away.max() < 1e-3
        page.screenshot(path=tmp_path / f"{share}.png")
        shares.append((np.asarray(Image.open(tmp_path / f"{share}.png")) < 250).mean())
    assert min(shares) > 0.02  # something is drawn
    assert errors == []
