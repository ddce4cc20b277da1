"""What people do on the studio's page: the gestures that its tests are written in."""

import json
import re
from pathlib import Path
from typing import Any

from playwright.sync_api import Download, Locator, Page, expect

VALID = re.compile(r"^Valid, (rises|falls) [\d,.]+ mm$")
PLACE = """
(world, [x, y]) => {
  const to = world.getScreenCTM();
  return [to.a * x + to.e, to.d * y + to.f];
}
"""


def opened(page: Page, url: str) -> Page:
    """Open an address and wait until the design that it names is simulated."""
    page.goto(url)
    simulated(page)
    return page


def status(page: Page) -> Locator:
    """Return the line below, which says how the design stands."""
    return page.get_by_role("contentinfo")


def says(page: Page, text: str | re.Pattern[str]) -> None:
    """Wait until the line below says this of the design."""
    expect(status(page).locator(".status-main")).to_have_text(text)


def simulated(page: Page) -> None:
    """Wait until the current design has a shape."""
    says(page, VALID)


def saved(page: Page) -> None:
    """Wait until the server has the design."""
    expect(page.get_by_role("banner").get_by_text("Saved", exact=True)).to_be_visible()


def plan(page: Page) -> Locator:
    """Return the plan, without what lies around it."""
    return page.locator(".plan-canvas")


def shape(page: Page) -> Locator:
    """Return the view of the shape."""
    return page.get_by_role("region", name="Shape", exact=True)


def parts(page: Page) -> Locator:
    """Return the list of all parts."""
    return page.get_by_role("listbox", name="All parts")


def joints(page: Page) -> Locator:
    """Return the joints of the plan."""
    return plan(page).get_by_role("option", name=re.compile(r"^Joint "))


def beams(page: Page) -> Locator:
    """Return the beams of the plan."""
    return plan(page).get_by_role("option", name=re.compile(r"^Beam "))


def joint(page: Page, number: int) -> Locator:
    """Return a joint of the plan; its name says where it is."""
    return plan(page).get_by_role("option", name=re.compile(rf"^Joint {number},"))


def beam(page: Page, number: int) -> Locator:
    """Return a beam of the plan; its name says its length and actuator."""
    return plan(page).get_by_role("option", name=re.compile(rf"^Beam {number},"))


def placed(locator: Locator, *numbers: float) -> None:
    """Wait until the name of a part says these numbers, in whatever way they are written."""
    words = [("[-−]" if n < 0 else "") + rf"{abs(n):g}(\.0)?" for n in numbers]
    expect(locator).to_have_accessible_name(re.compile(rf"[ ,]{', '.join(words)}( mm)?(,|$)"))


def at(page: Page, point: tuple[float, float]) -> tuple[float, float]:
    """Return where a point of the plan, in mm, is in the window."""
    x, y = page.locator(".plan-world").evaluate(PLACE, list(point))
    return x, y


def click(page: Page, point: tuple[float, float], **options: Any) -> None:
    """Move to a point of the plan and click."""
    x, y = at(page, point)
    page.mouse.move(x, y)
    page.mouse.click(x, y, **options)


def drag(page: Page, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Drag from one point of the plan to another."""
    page.mouse.move(*at(page, start))
    page.mouse.down()
    page.mouse.move(*at(page, end), steps=5)
    page.mouse.up()


def draw(page: Page, *points: tuple[float, float]) -> None:
    """Draw a line of beams; the key Enter ends it unless it is closed."""
    page.get_by_role("button", name="Draw", exact=True).click()
    for point in points:
        click(page, point)
    if points[0] != points[-1]:
        page.keyboard.press("Enter")


def use(page: Page, tool: str) -> None:
    """Take a tool of the plan."""
    page.get_by_role("group", name="Tools of the plan").get_by_role("button", name=tool).click()


def tab(page: Page, name: str) -> Locator:
    """Choose a tab of the side panel and return its panel."""
    page.get_by_role("tab", name=name).click()
    panel = page.get_by_role("tabpanel", name=name)
    expect(panel).to_be_visible()
    return panel


def choose(page: Page, menu: str, item: str) -> None:
    """Choose an item of a menu in the bar."""
    bar = page.get_by_role("banner")
    bar.get_by_role("button", name=menu, exact=True).click()
    # Items may end with the keys that do the same.
    name = re.compile(rf"^{re.escape(item)}( \S+){{0,2}}$")
    items = bar.get_by_role("menu")
    items.get_by_role("menuitem", name=name).or_(
        items.get_by_role("menuitemradio", name=name)
    ).click()


def button(page: Page, name: str | re.Pattern[str]) -> Locator:
    """Return the button of a name."""
    return page.get_by_role("button", name=name, exact=True)


def open_file(page: Page, name: str, content: Any) -> None:
    """Open a file with the menu."""
    data = content if isinstance(content, bytes) else json.dumps(content).encode()
    with page.expect_file_chooser() as choosing:
        choose(page, "File", "Open…")
    file = {"name": name, "mimeType": "application/json", "buffer": data}
    choosing.value.set_files(file)  # type: ignore[arg-type]


def downloaded(download: Download) -> str:
    """Return the text of a file that was downloaded."""
    return Path(download.path()).read_text(encoding="utf-8")


def document(page: Page) -> Any:
    """Return the design, as it is saved as a file."""
    with page.expect_download() as waiting:
        choose(page, "File", "Save as file")
    return json.loads(downloaded(waiting.value))


def fact(place: Locator, name: str) -> Locator:
    """Return what a list of facts says of a name."""
    return (
        place.locator("dl > div").filter(has=place.page.get_by_text(name, exact=True)).locator("dd")
    )


def focused(page: Page) -> str:
    """Return the name of what the keyboard is on."""
    name: str = page.evaluate(
        "() => document.activeElement.ariaLabel ?? document.activeElement.labels?.[0]?.innerText"
        " ?? document.activeElement.innerText"
    )
    return name


def tab_to(page: Page, name: str, key: str = "Tab") -> None:
    """Press Tab until the keyboard is on what begins with this name."""
    seen = []
    for _ in range(60):
        if focused(page).startswith(name):
            return
        page.keyboard.press(key)
        seen.append(focused(page))
    raise AssertionError(f"{key} does not reach {name!r}, but {seen}")


def scrolls_sideways(page: Page) -> bool:
    """Return whether the page is wider than the window."""
    wider: bool = page.evaluate(
        "() => document.documentElement.scrollWidth > document.documentElement.clientWidth"
    )
    return wider
