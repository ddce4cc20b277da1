"""How long the designer waits in the studio, measured in the browser.

Chromium renders in software, on the machine that also runs the server; a graphics card only makes
it faster. Times are from a change of the document to the frame in which its shape is drawn.

    python benchmarks/studio.py [--edits 10000]
"""

import argparse
import json
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import psutil
from playwright.sync_api import Page

from browsing import Studio, chromium, running, start
from report import Report
from simulearn.grid import Rules, draw_valid, drop_beams, grid_to_dict, make

SIZE = {"width": 1440, "height": 900}
STARTS = 5
# Counts the frames in which something is drawn into a canvas.
COUNTER = """
window.drawnFrames = 0;
let counted = -1;
for (const name of ["drawElements", "drawArrays"]) {
  const draw = WebGL2RenderingContext.prototype[name];
  WebGL2RenderingContext.prototype[name] = function (...args) {
    const now = document.timeline.currentTime;
    if (now !== counted) { counted = now; window.drawnFrames += 1; }
    return draw.apply(this, args);
  };
}
"""
# Applies changes one by one; returns for each the ms until its shape is drawn.
CHANGES = """
async (changes) => {
  const { state, edit } = await import("/page/store.js");
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  const spent = [];
  for (const change of changes) {
    const begun = performance.now();
    edit((document) => ({ ...document, goals: [], grid: change }), { label: "change" });
    let before = window.drawnFrames;
    while (state.check?.document.grid !== state.document.grid) {
      before = window.drawnFrames;
      await frame();
    }
    if (state.check.errors.length > 0) throw new Error(state.check.errors[0].message);
    while (window.drawnFrames === before) await frame();
    spent.push(performance.now() - begun);
    await new Promise((done) => setTimeout(done, 60));
  }
  return spent;
}
"""
# Moves a joint back and forth, as fast as answers come; nothing is measured but memory.
EDITS = """
async (count) => {
  const { state, edit } = await import("/page/store.js");
  for (let k = 0; k < count; k += 1) {
    const joints = state.document.grid.joints.map((p) => [...p]);
    joints[0] = [joints[0][0] + (k % 2 ? 1 : -1), joints[0][1]];
    const actuators = state.document.grid.actuators.map((r, b) => (b === k % 4 ? -r : r));
    edit((d) => ({ ...d, grid: { ...d.grid, joints, actuators } }), { label: "move" });
    while (state.check?.document.grid !== state.document.grid)
      await new Promise((done) => setTimeout(done, 2));
  }
}
"""


def main() -> None:
    """Measure, and write docs/measured/studio.md."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--edits", type=int, default=10_000, help="of the long session")
    edits = parser.parse_args().edits
    report = Report("studio", "Waiting in the studio")
    rows: list[list[object]] = []
    with tempfile.TemporaryDirectory() as folder, chromium() as browser:
        starts = []
        for _ in range(STARTS):
            one = start(Path(folder))
            starts.append(one.seconds)
            one.stop()
        rows.append(row("from the command to a server that answers, s", 3, starts))
        with running(Path(folder)) as studio:
            opened, morphed = [], []
            for _ in range(STARTS):  # each with an empty cache
                page = browser.new_context(viewport=SIZE).new_page()
                a, b = first_look(page, studio)
                opened.append(a)
                morphed.append(b)
                page.context.close()
            rows.append(row("from opening the page until it can be used, s", 2, opened))
            rows.append(
                row("from opening the page until the morphed shape is seen, s", "", morphed)
            )
            page = browser.new_context(viewport=SIZE).new_page()
            page.add_init_script(COUNTER)
            first_look(page, studio)
            rows.append(row("a change to its new shape, 2x2 grid, ms", 150, changed(page, known())))
            rows.append(row("the same, topologies never met, ms", 150, changed(page, unknown())))
            rows.append(row("orbit of a 4x4 grid, frames/s", "at least 25", [orbit(page)], 0))
            rows.append(
                row("play of a grid of 200 beams, frames/s", "at least 30", [play(page)], 0)
            )
            report.table(["what", "limit", "median", "worst", "of"], rows)
            page.context.close()
            if edits:
                page = browser.new_context(viewport=SIZE).new_page()
                first_look(page, studio)
                memory(page, studio, edits, report)
    report.save()


def row(what: str, limit: object, values: list[float], digits: int | None = None) -> list[object]:
    """Return a row of the table."""
    places = digits if digits is not None else (2 if max(values) < 10 else 0)
    median, worst = float(np.median(values)), max(values)
    return [what, limit, f"{median:.{places}f}", f"{worst:.{places}f}", len(values)]


def first_look(page: Page, studio: Studio) -> tuple[float, float]:
    """Open the page; return the seconds until it can be used, and until the shape is there."""
    begun = time.perf_counter()
    page.goto(studio.url)
    page.locator("canvas").first.wait_for()
    usable = time.perf_counter() - begun
    page.wait_for_function(
        "() => import('/page/store.js').then(({ state }) => state.answer !== null)"
    )
    return usable, time.perf_counter() - begun


def known() -> list[Any]:
    """Return random 2x2 designs of one topology."""
    return [grid_to_dict(draw_valid(Rules(), 3, k)[0]) for k in range(60)]


def unknown() -> list[Any]:
    """Return designs of topologies of which none was seen before."""
    random = np.random.default_rng(5)
    whole = make("bowl", (3, 3), 45.0)
    gone = {tuple(sorted(random.choice(24, 3, replace=False).tolist())) for _ in range(40)}
    return [grid_to_dict(drop_beams(whole, list(beams))) for beams in sorted(gone)]


def changed(page: Page, changes: list[Any]) -> list[float]:
    """Return the ms from each change to its shape."""
    spent: list[float] = page.evaluate(CHANGES, changes)
    return spent


def show(page: Page, grid: Any) -> None:
    """Draw a grid, and wait for its shape."""
    page.evaluate(CHANGES, [grid])
    page.wait_for_timeout(1000)


def orbit(page: Page) -> float:
    """Return the frames drawn in a second while the mouse turns a 4x4 grid."""
    show(page, grid_to_dict(make("wave", (4, 4), 40.0)))
    box = page.locator("canvas").first.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] * 0.6
    page.mouse.move(x, y)
    page.mouse.down()
    before, begun = page.evaluate("window.drawnFrames"), time.perf_counter()
    k = 0
    while time.perf_counter() - begun < 4:
        k += 1
        page.mouse.move(x + 120 * np.sin(k / 20), y + 40 * np.cos(k / 20))
    seconds = time.perf_counter() - begun
    count = page.evaluate("window.drawnFrames") - before
    page.mouse.up()
    return float(count / seconds)


def play(page: Page) -> float:
    """Return the frames drawn in a second while a grid of 200 beams morphs."""
    whole = make("wave", (10, 9), 26.0)
    grid = drop_beams(whole, list(range(len(whole.beams) - 200)))
    show(page, grid_to_dict(grid))
    code = """async () => {
      const { view } = await import("/page/store.js");
      view.loop = true; view.playing = true;
      await new Promise((done) => setTimeout(done, 500));
      const before = window.drawnFrames, begun = performance.now();
      await new Promise((done) => setTimeout(done, 4000));
      const rate = (window.drawnFrames - before) / (performance.now() - begun) * 1000;
      view.playing = false;
      return rate;
    }"""
    return float(page.evaluate(code))


def memory(page: Page, studio: Studio, edits: int, report: Report) -> None:
    """Edit for a long time, and say what page and server take."""
    session = page.context.new_cdp_session(page)
    server = psutil.Process(studio.process.pid)
    parts, rows = 10, []
    begun = time.perf_counter()
    for part in range(parts):
        page.evaluate(EDITS, edits // parts)
        session.send("HeapProfiler.collectGarbage")
        used = session.send("Runtime.getHeapUsage")["usedSize"]
        resident = server.memory_info().rss
        rows.append(
            [(part + 1) * (edits // parts), f"{used / 2**20:.1f}", f"{resident / 2**20:.0f}"]
        )
        print(json.dumps(rows[-1]), flush=True)
    seconds = time.perf_counter() - begun
    report.say(f"A long session: {edits} edits, each simulated, in {seconds:.0f} s.")
    report.table(["edits", "page, MB of objects", "server, MB"], rows)


if __name__ == "__main__":
    main()
