"""The studio's pictures in the docs: each state of the page, light and dark, and one animation.

python benchmarks/studio_pictures.py [-o docs/pictures/studio] [--only NAME...]
"""

import argparse
import io
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image
from playwright.sync_api import Browser, Locator, Page

from browsing import chromium, running

FOLDER = Path(__file__).parent.parent / "docs" / "pictures" / "studio"
WIDE, TABLET, PHONE = (1280, 800), (820, 1180), (390, 844)
COLOURS = 128  # of a picture, which has few tones and should load fast
SETTLED = 600  # ms after which a shape that moved is drawn finely
SECONDS = 60_000.0  # ms that a computation may take
Shot = Callable[[Page], None]


def plan(page: Page) -> Locator:
    """Return the plan."""
    return page.get_by_role("region", name="Plan")


def at(page: Page, x: float, y: float) -> tuple[float, float]:
    """Return where a point of the plan (mm) is on the page."""
    place = page.evaluate(
        """async ([x, y]) => {
          const { state } = await import("/page/store.js");
          const k = state.document.grid.joints.length;
          const places = [...document.querySelectorAll("[data-joint]")].map((e) => {
            const box = e.getBoundingClientRect();
            return [+e.dataset.joint, box.x + box.width / 2, box.y + box.height / 2];
          });
          const joints = state.document.grid.joints;
          const [a, ax, ay] = places[0];
          const [b, bx, by] = places.find(([n]) => joints[n][0] !== joints[a][0]);
          const scale = (bx - ax) / (joints[b][0] - joints[a][0]);
          return [ax + (x - joints[a][0]) * scale, ay - (y - joints[a][1]) * scale];
        }""",
        [x, y],
    )
    return place[0], place[1]


def tab(page: Page, name: str) -> None:
    """Choose a tab of the side panel."""
    page.get_by_role("tab", name=name, exact=True).click()


def goals(page: Page) -> None:
    """Set two goals, and wait for suggestions."""
    tab(page, "Goals")
    page.evaluate(
        """async () => {
          const { edit } = await import("/page/store.js");
          const { addGoal } = await import("/page/document/goals.js");
          edit((d) => addGoal(addGoal(d, ["joint", 2, "centre"], [60, -60, -12]),
            ["joint", 6, "centre"], [-60, 60, -12]), { label: "goals" });
        }"""
    )
    page.get_by_text("closer").first.wait_for(timeout=SECONDS)
    page.wait_for_timeout(1500)


def start(page: Page) -> None:
    """The first look."""


def library(page: Page) -> None:
    """The library."""
    page.get_by_role("button", name="Library").click()
    page.locator("dialog img").nth(9).wait_for()


def beam(page: Page) -> None:
    """A beam is selected."""
    page.mouse.click(*at(page, 32.5, 65))


def drawing(page: Page) -> None:
    """A polyline is being drawn across beams."""
    plan(page).click(position={"x": 5, "y": 400})
    page.keyboard.press("Escape")
    page.keyboard.press("d")
    page.mouse.click(*at(page, -65, 65))
    page.mouse.move(*at(page, 20, -20), steps=8)


DROP = """([name, text]) => {
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([text], name));
  document.querySelector(".page").dispatchEvent(
    new DragEvent("drop", { bubbles: true, cancelable: true, dataTransfer }));
}"""
OWN = """base = "voron"
name = "delta"
title = "Delta in the workshop"
sources = []

[bed]
shape = "round"
width = 240.0
depth = 240.0
origin = "centre"
excluded = [[[80.0, -120.0], [120.0, -60.0]]]
"""
# As people draw: lines that end short of others, run past them, cross them and end on them.
SKETCH = """<svg xmlns="http://www.w3.org/2000/svg" fill="none" viewBox="0 0 195 130"
  xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="195mm" height="130mm">
  <g inkscape:groupmode="layer" inkscape:label="passive" stroke="#dcdcdc">
    <path d="M0 0H194.6M0 65H195.7M0 130H195M130 65V130"/>
    <text x="5" y="20">front</text>
  </g>
  <g inkscape:groupmode="layer" inkscape:label="top 0.75" stroke="#db7525">
    <path d="M0 0V64.7M195 0V130M65 0.3V65.4"/>
  </g>
  <g inkscape:groupmode="layer" inkscape:label="bottom 0.5" stroke="#4a9bc8">
    <path d="M0 65V130M130 0V65M65 130V65.2"/>
  </g>
</svg>"""


def importing(page: Page) -> None:
    """A drawing has been dropped, and the places of one kind of mend are shown."""
    page.evaluate(DROP, ["roof panel.svg", SKETCH])
    gaps = page.get_by_role("button", name="gaps closed")
    gaps.wait_for()
    page.locator(".notice").get_by_role("button", name="Close").click()
    page.wait_for_timeout(2000)
    gaps.hover()


def error(page: Page) -> None:
    """An actuator is too short."""
    page.evaluate(
        """async () => {
          const { edit } = await import("/page/store.js");
          const { setActuators } = await import("/page/document/edit.js");
          edit((d) => setActuators(d, [0], 0.02), { label: "actuator" });
        }"""
    )
    page.get_by_role("button", name="Raise").or_(page.locator(".problems button")).first.wait_for()


def suggestion(page: Page) -> None:
    """A suggestion is shown in the scene."""
    goals(page)
    page.get_by_role("button", name="closer").first.hover()


def search(page: Page) -> None:
    """A search has found a design."""
    goals(page)
    page.get_by_role("button", name="Search", exact=True).click()
    page.get_by_role("button", name="Take it").wait_for(timeout=SECONDS)
    page.get_by_role("button", name="Take it").scroll_into_view_if_needed()


def surface(page: Page) -> None:
    """A surface has been dropped, and all joints are to lie on it."""
    x, y = np.meshgrid(*[np.linspace(-80, 80, 33)] * 2)
    vertices = np.c_[x.ravel(), y.ravel(), (12 * np.cos(x / 40) - 12 + y**2 / 300).ravel()]
    k = np.arange(x.size).reshape(x.shape)
    a, b, c, d = k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3) + 1
    lines = [f"v {u:.3f} {v:.3f} {w:.3f}" for u, v, w in vertices]
    lines += [f"f {i} {j} {k}" for i, j, k in faces]
    page.evaluate(DROP, ["hood.obj", "\n".join(lines)])
    page.get_by_text("closer").first.wait_for(timeout=SECONDS)
    page.locator(".notice").get_by_role("button", name="Close").click()
    page.wait_for_timeout(2500)


def check(page: Page) -> None:
    """A design is checked by finite elements."""
    tab(page, "Check")
    page.get_by_role("button", name="Check with finite elements").click()
    page.get_by_text("mean distance between").wait_for(timeout=SECONDS)
    page.get_by_label("Colour by deviation").check()


def printing(page: Page) -> None:
    """The toolpath."""
    tab(page, "Print")
    page.get_by_text("Filament").first.wait_for(timeout=SECONDS)
    page.get_by_role("slider", name="Layer").fill("1")
    page.locator(".side-body").evaluate("(panel) => { panel.scrollTop = 0; }")
    page.wait_for_timeout(1500)


def profile(page: Page) -> None:
    """The first layer on a printer of one's own, whose bed is round and has an empty zone."""
    printing(page)
    page.evaluate(DROP, ["delta.toml", OWN])
    page.get_by_text("Round bed").wait_for(timeout=SECONDS)
    page.get_by_role("switch", name="Show travels").check()
    page.locator(".notice").get_by_role("button", name="Close").click()
    page.wait_for_timeout(2500)


def export(page: Page) -> None:
    """The dialog of exports."""
    page.get_by_role("button", name="File").click()
    page.get_by_role("menuitem", name="Export…").click()


def keys(page: Page) -> None:
    """The list of keys."""
    page.get_by_role("button", name="Keyboard help").first.click()


STATES: dict[str, tuple[tuple[int, int], Shot]] = {
    "start": (WIDE, start),
    "library": (WIDE, library),
    "beam": (WIDE, beam),
    "drawing": (WIDE, drawing),
    "import": (WIDE, importing),
    "error": (WIDE, error),
    "goals": (WIDE, goals),
    "suggestion": (WIDE, suggestion),
    "search": (WIDE, search),
    "surface": (WIDE, surface),
    "check": (WIDE, check),
    "print": (WIDE, printing),
    "profile": (WIDE, profile),
    "export": (WIDE, export),
    "keys": (WIDE, keys),
    "tablet": (TABLET, start),
    "phone": (PHONE, start),
}


def opened(browser: Browser, url: str, size: tuple[int, int], theme: str) -> Page:
    """Return a page that shows the first design's shape."""
    context = browser.new_context(
        viewport={"width": size[0], "height": size[1]},
        color_scheme="dark" if theme == "dark" else "light",
        reduced_motion="reduce",
    )
    page = context.new_page()
    page.goto(url)
    page.get_by_role("contentinfo").get_by_text("Valid, ").wait_for(timeout=SECONDS)
    page.wait_for_timeout(1500)
    return page


def saved(image: Image.Image, path: Path) -> None:
    """Write a picture with few colours."""
    image.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


def picture(page: Page) -> Image.Image:
    """Return what the page shows."""
    return Image.open(io.BytesIO(page.screenshot()))


def animation(browser: Browser, url: str, path: Path) -> None:
    """Drag a joint while the shape follows, then let the grid morph."""
    page = opened(browser, url, (1120, 660), "light")
    page.get_by_role("button", name="Do not show this hint again").click()
    page.wait_for_timeout(500)
    frames, times = [], []

    def take(milliseconds: int) -> None:
        frames.append(picture(page).resize((896, 528), Image.Resampling.LANCZOS))
        times.append(milliseconds)

    take(700)
    x, y = at(page, 65, 65)
    scale = at(page, 66, 65)[0] - x
    page.mouse.move(x, y)
    page.mouse.down()
    for k in range(1, 21):
        turn = np.sin(np.pi * k / 20)
        page.mouse.move(x - 26 * turn * scale, y + 22 * turn * scale)
        page.wait_for_timeout(SETTLED)
        take(70)
    page.mouse.up()
    page.keyboard.press("Escape")
    page.mouse.move(700, 640)
    for ratio in (0.25, 0.5, 0.75, 1.0):
        page.evaluate(
            """async (ratio) => {
              const { edit } = await import("/page/store.js");
              const { setActuators } = await import("/page/document/edit.js");
              edit((d) => setActuators(d, [2, 3, 8, 9], ratio), { label: "actuators" });
            }""",
            ratio,
        )
        page.wait_for_timeout(SETTLED)
        take(350)
    slider = page.get_by_role("slider", name="From flat to morphed")
    for frame in [*np.linspace(0, 11, 24), *[11.0] * 3]:
        slider.fill(f"{frame:.2f}")
        page.wait_for_timeout(SETTLED)
        take(80 if frame < 11 else 700)
    small = [one.convert("RGB").quantize(96, dither=Image.Dither.NONE) for one in frames]
    small[0].save(
        path, save_all=True, append_images=small[1:], duration=times, loop=0, optimize=True
    )
    page.context.close()


def main() -> None:
    """Make the pictures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=FOLDER)
    parser.add_argument("--only", nargs="*", help="names of states, or animation")
    wanted = parser.parse_args()
    wanted.output.mkdir(parents=True, exist_ok=True)
    with (
        tempfile.TemporaryDirectory() as folder,
        chromium() as browser,
        running(Path(folder)) as studio,
    ):
        for name, (size, shot) in STATES.items():
            if wanted.only and name not in wanted.only:
                continue
            for theme in ("light", "dark"):
                page = opened(browser, studio.url, size, theme)
                shot(page)
                page.wait_for_timeout(700)
                saved(picture(page), wanted.output / f"{name}-{theme}.png")
                page.context.close()
                print(name, theme, flush=True)
        if not wanted.only or "animation" in wanted.only:
            animation(browser, studio.url, wanted.output / "studio.gif")


if __name__ == "__main__":
    main()
