"""An assembly as one HTML file: it plays without a network, and says what collides."""

import json
import re
from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

import assembling
from simulearn.assembly import Assembly, Part, Step, simulate_assembly
from simulearn.interop import write_assembled_html
from simulearn.show import Camera

ODD = "</title><script>document.title='run'</script>"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    parts = (
        Part("first", assembling.SQUARE),
        Part(ODD, assembling.SQUARE, assembling.at(0, 0, 2), "first"),
        Part("bad", assembling.BROKEN),
    )
    steps = (Step(("first",)), Step((ODD,), 1.0, {ODD: (0.0, 0.0, 60.0)}, name="in"))
    path = tmp_path_factory.mktemp("page") / "two.html"
    assembled = simulate_assembly(Assembly(parts, steps), assembling.Rolling())
    write_assembled_html(assembled, path, Camera(-60, 30))
    return path


def test_the_page_holds_what_is_to_be_known(path):
    text = path.read_text("utf-8")
    contents = json.loads(re.search(r'id="simulearn-result">([^<]*)<', text)[1])
    assert contents["parts"] == ["first", ODD]
    assert [step["name"] for step in contents["steps"]] == ["first", "in"]
    assert contents["warnings"] == ["bad: there is no answer"]
    assert contents["collisions"]
    assert "<title>two</title>" in text


def test_it_plays_offline(path, visit):
    tab = visit(offline=True, reduced_motion="reduce")
    requests, wrong = [], []
    tab.on("request", lambda request: requests.append(request.url))
    tab.on("pageerror", lambda error: wrong.append(error))
    tab.goto(path.as_uri())
    tab.locator(".view canvas").wait_for()
    pictures = []
    for key, words in (("Home", "Step 1 of 2: first"), ("End", "Step 2 of 2: in")):
        tab.get_by_role("slider").press(key)
        expect(tab.locator(".step")).to_have_text(words)
        with Image.open(BytesIO(tab.locator(".view").screenshot())) as image:
            pictures.append(np.asarray(image.convert("L"), dtype=float))
    assert np.abs(pictures[0] - pictures[1]).mean() > 1
    expect(tab.get_by_role("complementary")).to_contain_text("first")
    expect(tab.get_by_role("complementary")).to_contain_text("bad: there is no answer")
    expect(tab.get_by_role("heading", name="Collisions")).to_be_visible()
    tab.get_by_role("button", name="Play").click()
    expect(tab.get_by_role("button", name="Pause")).to_be_visible()
    assert tab.title() == "two"
    assert requests == [path.as_uri()]
    assert wrong == []
