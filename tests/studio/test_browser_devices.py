"""Small windows, fingers, German, light and dark."""

import re

import pytest
from playwright.sync_api import expect

import gestures as do

PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
TABLET = {"viewport": {"width": 820, "height": 1180}, "has_touch": True}
TABS = ("Design", "Goals", "Check", "Print")
CUT_OFF = """
() => [...document.querySelectorAll("button, input, select, a")]
  .filter((element) => element.checkVisibility({ visibilityProperty: true }))
  .map((element) => [element.ariaLabel ?? element.innerText, element.getBoundingClientRect()])
  .filter(([, { left, right, width }]) => width > 2 && (left < -0.5 || right > innerWidth + 0.5))
  .map(([name]) => name)
"""


@pytest.fixture
def touch(page):
    """Return a function that puts fingers on the window, moves them and lifts them."""
    session = page.context.new_cdp_session(page)

    def touch(kind, *points):
        places = [{"x": x, "y": y} for x, y in points]
        session.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": places})

    return touch


@pytest.mark.parametrize("page", [PHONE, TABLET], indirect=True, ids=["phone", "tablet"])
def test_small_windows_are_enough(page, studio):
    do.opened(page, studio.url)
    for name in TABS:
        panel = do.tab(page, name)
        expect(panel.get_by_role("button").first).to_be_visible()
        assert not do.scrolls_sideways(page)
        assert page.evaluate(CUT_OFF) == []
    do.tab(page, "Design")
    if page.viewport_size["width"] < 600:
        do.button(page, "Close the panel").click()
        expect(page.get_by_role("application", name="Shape in space")).to_be_visible()
        page.get_by_role("radio", name="Plan").click()
    expect(do.joints(page)).to_have_count(9)
    page.touchscreen.tap(*do.at(page, (32, 65)))
    do.button(page, "A quarter more to the bottom").tap()
    expect(do.beam(page, 11)).to_have_accessible_name(re.compile("75 % top"))
    do.simulated(page)


@pytest.mark.parametrize("page", [TABLET], indirect=True)
def test_fingers_drag_joints_and_zoom(page, studio, touch):
    do.opened(page, studio.url)
    touch("Start", do.at(page, (65, 65)))
    for x in (68, 72, 75):
        touch("Move", do.at(page, (x, 65)))
    touch("End")
    do.placed(do.joint(page, 8), 75, 65)
    do.simulated(page)
    (ax, ay), (bx, by) = do.at(page, (-20, 30)), do.at(page, (20, 30))
    touch("Start", (ax, ay), (bx, by))
    for away in (10, 20, 30):
        touch("Move", (ax - away, ay), (bx + away, by))
    touch("End")
    expect(do.button(page, "Undo: Move joint")).to_be_enabled()  # and nothing after it

    def apart():
        (a, _), (b, _) = do.at(page, (-20, 30)), do.at(page, (20, 30))
        return b - a

    assert apart() > 1.2 * (bx - ax)


@pytest.mark.parametrize("page", [{"locale": "de-DE"}], indirect=True)
def test_german(page, studio):
    page.goto(studio.url)
    expect(page.locator("html")).to_have_attribute("lang", "de")
    do.says(page, re.compile(r"^Gültig, (steigt|hebt|fällt|senkt)"))
    english = re.compile(r"\b(the|and|of|with|joint|beam|joints|beams|not|is)\b", re.IGNORECASE)
    for name in ("Entwurf", "Ziele", "Prüfen", "Druck"):
        panel = do.tab(page, name)
        expect(panel.get_by_role("button").first).to_be_visible()
        text = page.locator("body").inner_text()
        for words in ("PLA in water of 80 C", *page.locator(".callout.warning").all_inner_texts()):
            text = text.replace(words, "")  # the server's own words are English
        assert english.findall(text) == []
    page.get_by_role("button", name="Einstellungen").click()
    page.get_by_role("menuitemradio", name="English").click()
    expect(page.get_by_role("tab", name="Design")).to_be_visible()
    page.reload()
    expect(page.get_by_role("tab", name="Design")).to_be_visible()


def brightness(page):
    """Return how bright the page's background is, 0 to 255."""
    colour = page.evaluate("() => getComputedStyle(document.body).backgroundColor")
    return sum(map(float, re.findall(r"[\d.]+", colour)[:3])) / 3


@pytest.mark.parametrize("page", [{"color_scheme": "dark"}], indirect=True)
def test_dark_as_the_system_and_light_by_choice(page, studio):
    do.opened(page, studio.url)
    assert brightness(page) < 60
    do.choose(page, "Settings", "Light")
    expect(page.locator("html")).to_have_attribute("data-theme", "light")
    assert brightness(page) > 200
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", "light")
    do.choose(page, "Settings", "As the system")
    expect(page.locator("html")).to_have_attribute("data-theme", "dark")
