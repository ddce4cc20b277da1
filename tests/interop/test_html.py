"""A result as one HTML file: it plays without a network, says what it knows, and is read back."""

import dataclasses
import importlib.util
import json
import random
import re
from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

import synthetic
from simulearn.errors import InputError, Message
from simulearn.grid import grid_from_dict, make, read_grid, write_grid
from simulearn.interop import write_html
from simulearn.interop.bundle import Bundle
from simulearn.interop.html import OWN, STUDIO, page
from simulearn.interop.html_reading import result_of_html
from simulearn.interop.libraries import libraries
from simulearn.material import Identity
from simulearn.schedule import Snap
from simulearn.simulate import FRAMES
from simulearn.studio.exports import exported
from simulearn.studio.opening import opened as opened_by_studio

ODD = "</title><script>document.title='run'</script>&\"'<b>"
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


@pytest.fixture(scope="module")
def result():
    return synthetic.result(solid=False)


@pytest.fixture
def file(tmp_path, result):
    path = tmp_path / "my saddle.html"
    write_html(result, path)
    return path


@pytest.fixture
def opened(visit):
    """Return a function that opens a page with the network off, and waits for the shape."""

    def opened(path, ready=".shape-canvas canvas", script=None, **options):
        tab = visit(**{"offline": True, "reduced_motion": "reduce"} | options)
        if script is not None:
            tab.add_init_script(script)
        tab.requests = []
        tab.on("request", lambda request: tab.requests.append(request.url))
        tab.goto(path.as_uri())
        tab.locator(ready).first.wait_for()
        return tab

    return opened


def seen(tab, moment):
    """Return the pixels of the shape at a moment: "Home" or "End" of the slider."""
    tab.get_by_role("slider").press(moment)
    tab.wait_for_timeout(600)  # ms, until it is drawn finely
    with Image.open(BytesIO(tab.locator(".shape-canvas").screenshot())) as image:
        return np.asarray(image.convert("L"), dtype=float)


def qualified(result, **more):
    """Return a result with everything that can qualify one."""
    return dataclasses.replace(
        result,
        engine="learned",
        model=Identity(name="equilibrium", digest="5" * 64),
        stable=False,
        bound_mm=0.31,
        snaps=(Snap(released=0.42, frame=5),),
        warnings=(Message("odd", "beam 3", ODD),),
        **more,
    )


def test_plays_without_a_network(opened, file):
    tab = opened(file)
    flat, morphed = seen(tab, "Home"), seen(tab, "End")
    assert flat.std() > 2
    assert np.abs(flat - morphed).mean() > 1
    slider = tab.get_by_role("slider")
    slider.press("Home")
    tab.get_by_role("button", name="Play").click()
    expect(slider).not_to_have_value("0")
    tab.get_by_role("button", name="Pause").click()
    assert [url for url in tab.requests if not url.startswith(("data:", "blob:"))] == [
        file.as_uri()
    ]


def test_turns_by_keys_mouse_and_touch(opened, file):
    tab = opened(file, has_touch=True)
    first = seen(tab, "End")
    tab.locator(".shape-canvas").press("ArrowLeft")
    by_key = seen(tab, "End")
    assert np.abs(first - by_key).mean() > 0.5
    box = tab.locator(".shape-canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.mouse.move(x, y)
    tab.mouse.down()
    tab.mouse.move(x + 120, y + 30, steps=4)
    tab.mouse.up()
    by_mouse = seen(tab, "End")
    assert np.abs(by_key - by_mouse).mean() > 0.5
    tab.mouse.wheel(0, -400)
    assert np.abs(by_mouse - seen(tab, "End")).mean() > 0.5


def test_says_what_qualifies_the_answer(opened, tmp_path, result):
    path = tmp_path / "a.html"
    write_html(qualified(result), path)
    tab = opened(path)
    words = tab.get_by_role("complementary").inner_text()
    for part in ("Learned model", "equilibrium", "pla-hot-water", "0.3 mm", "unstable", "42 %"):
        assert part in words
    assert ODD in words  # as it is, and not run
    assert tab.title() == "a"
    tab = opened(path, locale="de-DE", color_scheme="dark")
    words = tab.locator("body").inner_text()
    for part in ("Gitter herunterladen", "Gelerntes Modell", "labil", "0,3 mm", "Abspielen"):
        assert part in words or tab.get_by_role("button", name=part).count()
    root = tab.locator("html")
    assert (root.get_attribute("lang"), root.get_attribute("data-theme")) == ("de", "dark")


def test_title_is_text(opened, tmp_path, result):
    path = tmp_path / "odd.html"
    path.write_text(page(result, ODD), "utf-8")
    tab = opened(path)
    assert tab.title() == ODD
    assert tab.get_by_role("heading", level=1).inner_text() == ODD


def test_colours_by_stress_only_where_there_is_one(opened, tmp_path, result, file):
    option = "option[value=stress]"
    assert opened(file).locator(option).is_enabled()
    other = tmp_path / "other.html"
    write_html(dataclasses.replace(result, stress=None), other)
    assert opened(other).locator(option).is_disabled()


def test_policy_lets_nothing_else_run(opened, file, forgiven):
    forgiven.append("Content Security Policy")
    tab = opened(file)
    tab.evaluate("""() => {
      const script = document.createElement("script");
      script.textContent = "document.title = 'run'";
      document.body.append(script);
    }""")
    assert tab.title() == "my saddle"
    policy = tab.locator("meta[http-equiv]").get_attribute("content")
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy


def test_design_can_be_saved_from_the_page(opened, file, result, tmp_path):
    tab = opened(file)
    with tab.expect_download() as waiting:
        tab.get_by_role("button", name="Download grid").click()
    assert waiting.value.suggested_filename == "my-saddle.json"
    waiting.value.save_as(tmp_path / "grid.json")
    assert read_grid(tmp_path / "grid.json").digest == result.grid.digest


NO_WEBGL = "HTMLCanvasElement.prototype.getContext = () => null"
NO_STREAM = "delete globalThis.DecompressionStream"


@pytest.mark.parametrize(
    ("script", "words"),
    [(NO_WEBGL, "no WebGL"), (NO_STREAM, "newer browser"), (None, "needs JavaScript")],
)
def test_picture_stays_where_nothing_can_move(opened, file, script, words):
    tab = opened(file, ready="img", script=script, java_script_enabled=script is not None)
    tab.get_by_text(words).wait_for()
    picture = tab.get_by_role("img", name="The shape after creep")
    assert picture.is_visible()
    assert picture.bounding_box()["width"] > 300
    assert tab.locator("svg.plan").is_visible()


@pytest.mark.parametrize(
    "options",
    [{}, {"color_scheme": "dark"}, PHONE, {"locale": "de"}, {"script": NO_WEBGL, "ready": "img"}],
    ids=["light", "dark", "phone", "German", "still"],
)
def test_barriers(opened, tmp_path, result, axe, options):
    path = tmp_path / "shape.html"
    write_html(qualified(result), path)
    assert axe(opened(path, **options)) == []


def test_phone_has_no_sideways_scroll(opened, file):
    tab = opened(file, **PHONE)
    assert tab.evaluate("document.documentElement.scrollWidth") == 390


def test_same_result_gives_the_same_bytes(result, tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write_html(result, tmp_path / name / "shape.html")
    a, b = ((tmp_path / name / "shape.html").read_bytes() for name in ("a", "b"))
    assert a == b
    assert len(a) < 600_000
    assert b"\r" not in a


def test_missing_package_is_reported(result, tmp_path, monkeypatch):
    import simulearn.interop.html as module

    module._program.cache_clear()
    monkeypatch.setattr("simulearn.interop.libraries.find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"pip install 'simulearn\[studio\]'"):
        write_html(result, tmp_path / "a.html")
    assert list(tmp_path.iterdir()) == []


def test_result_is_read_back(result):
    given = qualified(result)
    read = result_of_html(page(given, ODD).encode())
    assert read.grid.digest == given.grid.digest
    assert (read.stable, read.bound_mm, read.snaps) == (False, 0.31, given.snaps)
    assert (read.warnings, read.material, read.model) == (
        given.warnings, given.material, given.model,
    )  # fmt: skip
    assert np.abs(read.joints - given.joints).max() < 6e-4
    assert np.abs(read.beams - given.beams).max() < 6e-4
    assert read.joints.shape[0] == FRAMES


def test_design_is_imported_from_a_page(run, file, result, tmp_path):
    code, _, _ = run("import", file, "-o", tmp_path / "grid.json")
    assert code == 0
    assert read_grid(tmp_path / "grid.json").digest == result.grid.digest


def test_studio_opens_a_page(file, result):
    parts = opened_by_studio(file.read_bytes(), file.name)
    assert (parts["kind"], parts["name"]) == ("result", "my saddle")
    assert grid_from_dict(parts["grid"]).digest == result.grid.digest


def test_command_writes_a_page(run, tmp_path):
    write_grid(make("saddle", (1, 1)), tmp_path / "grid.json")
    output = tmp_path / "shape.html"
    assert run("simulate", tmp_path / "grid.json", "--engine", "learned", "-o", output)[0] == 0
    assert result_of_html(output.read_bytes()).engine == "learned"


def test_studio_exports_a_page_with_the_design_as_its_title(result):
    data, name, kind = exported(result, ".html", "my-saddle")
    assert (name, kind) == ("my-saddle.html", "text/html; charset=utf-8")
    assert b"<title>my-saddle</title>" in data


@pytest.mark.parametrize("text", ["", "<html></html>", "{}", "<script id='simulearn-result'>"])
def test_other_pages_are_refused(text):
    with pytest.raises(InputError, match="not a page with a result"):
        result_of_html(text.encode())


def test_broken_pages_are_refused(result):
    text = page(result)
    begin = text.index('id="simulearn-result"')
    rng = random.Random(14)
    refused = 0
    for _ in range(100):
        broken = list(text)
        for _ in range(rng.randint(1, 20)):
            k = rng.randrange(begin, len(text))
            broken[k] = chr(rng.randrange(32, 127))
        if rng.random() < 0.3:
            broken = broken[: rng.randrange(begin, len(text))]
        try:
            result_of_html("".join(broken).encode())
        except InputError as error:
            refused += "\n" not in str(error)
    assert refused > 20


def test_frames_that_would_fill_the_memory_are_refused(result, monkeypatch):
    monkeypatch.setattr("simulearn.interop.html_reading.MOST_BYTES", 1000)
    with pytest.raises(InputError):
        result_of_html(page(result).encode())


def test_numbers_of_another_shape_are_refused(result):
    text = page(result)
    grid = json.loads(re.search(r'simulearn-result">([^<]*)<', text)[1])["grid"]
    fewer = {**grid, "joints": [*grid["joints"], [500.0, 500.0]]}
    with pytest.raises(InputError, match="shape"):
        result_of_html(text.replace(json.dumps(grid), json.dumps(fewer)).encode())


class TestBundle:
    def script(self, folder, **modules):
        for name, text in modules.items():
            (folder / f"{name}.js").write_text(text, "utf-8")
        return Bundle().script(folder / "main.js")

    def test_modules_run_once_and_in_order(self, tmp_path, node):
        import subprocess

        script = self.script(
            tmp_path,
            main='import { a as x, twice } from "./one.js";\nimport { b } from "./two.js";\n'
            "globalThis.console.log(x, b, twice(4));\n",
            one='export { b } from "./two.js";\nexport const a = 1;\n'
            "export function twice(x) {\n  return 2 * x;\n}\n",
            two='globalThis.console.log("two");\nexport const b = 7;\n',
        )
        done = subprocess.run([node, "-e", script], capture_output=True, text=True, check=True)
        assert done.stdout.split() == ["two", "1", "7", "8"]

    @pytest.mark.parametrize(
        "text",
        [
            'import x from "./one.js";\n',
            'import * as x from "./one.js";\n',
            "export default 3;\n",
            'const x = await import("./one.js");\n',
            'import { a } from "three";\n',
            'import { a } from "./main.js";\n',
        ],
    )
    def test_unknown_forms_are_errors(self, tmp_path, text):
        with pytest.raises(ValueError, match=r"known|cycle"):
            self.script(tmp_path, main=text, one="export const a = 1;\n")


def test_page_has_the_words_that_its_modules_use():
    bundle = Bundle(
        {"/page/": STUDIO},
        {f"/libraries/{name}": path for name, path in libraries().items()},
        {STUDIO / "text" / "text.js": OWN / "text.js"},
    )
    bundle.script(OWN / "main.js")
    used = set()
    for path in bundle.modules:
        if path.is_relative_to(STUDIO.resolve()) or path.is_relative_to(OWN):
            used |= set(re.findall(r"""\bt\([^)]*?["`](\w+)\.""", path.read_text("utf-8")))
    assert used == {"common", "shape", "share"}


def test_studio_extra_is_where_the_libraries_are():
    assert importlib.util.find_spec("nicegui") is not None
    assert all(path.is_file() for path in libraries().values())
