"""Twenty users at once for a minute: what each waits for, and that nothing fails.

Each user opens the page, changes a design every .4 s on average, and every so often asks for
suggestions, saves, checks by finite elements or makes a print file; all against one server.

    python benchmarks/studio_users.py [--users 20] [--seconds 60]
"""

import argparse
import asyncio
import secrets
import tempfile
import time
from collections import defaultdict
from pathlib import Path
from typing import Any

import httpx
import numpy as np

from browsing import running
from report import Report
from simulearn.grid import Grid, Rules, draw_valid, grid_to_dict
from simulearn.interop.frames import MEDIA_TYPE

PAUSE = 0.4  # s, mean, between two changes of one user
Spent = dict[str, list[float]]


async def user(client: httpx.AsyncClient, number: int, until: float, spent: Spent) -> None:
    """Work as one designer does."""
    random = np.random.default_rng(number)
    design = draw_valid(Rules(), 11, number)[0]
    name, revision = secrets.token_urlsafe(16), 0

    async def ask(what: str, method: str, path: str, body: Any = None, **headers: str) -> Any:
        begun = time.perf_counter()
        answer = await client.request(method, path, json=body, headers=headers)
        spent[what].append(time.perf_counter() - begun)
        if answer.is_error:
            code = answer.json().get("code", "")
            spent[f"error {answer.status_code} {code}: {what}"].append(1)
        return answer

    await ask("page", "GET", "/")
    step = 0
    while time.monotonic() < until:
        step += 1
        moved = design.joints + random.normal(0, 0.5, design.joints.shape)
        grid = grid_to_dict(
            Grid(moved, design.beams, design.actuators, design.fixed, design.material)
        )
        accept = {"Accept": MEDIA_TYPE}
        await ask("simulate", "POST", "/api/simulate", {"grids": [grid]}, **accept)
        if step % 5 == 0:
            document = {"schema": "simulearn.document/1", "name": "load", "grid": grid,
                        "goals": [], "printer": "ender-3"}  # fmt: skip
            saved = await ask("save", "PUT", f"/api/documents/{name}",
                              {"revision": revision, "document": document})  # fmt: skip
            revision = saved.json().get("revision", revision)
        if step % 20 == 7:
            goal = {"vertex": ["joint", (grid["fixed"] + 1) % 9, "centre"], "target": [50, 50, 10]}
            # A design that was moved may not be valid any more; that would be a fault of the user.
            task = {"schema": "simulearn.task/1", "grid": grid_to_dict(design), "goals": [goal]}
            await ask("rank", "POST", "/api/rank", task)
        if step % 60 == 30:
            await check(ask, grid)
        if step % 60 == 50:
            print_body = {"grids": [grid], "printer": "prusa-mk4"}
            await ask("print file", "POST", "/api/gcode", print_body)
        await asyncio.sleep(random.exponential(PAUSE))


async def check(ask: Any, grid: Any) -> None:
    """Check a design by finite elements; a queue that is full is an answer, too."""
    begun = time.perf_counter()
    made = (await ask("start of a check", "POST", "/api/fea", {"grids": [grid]})).json()
    while "job" in made:
        state = (await ask("progress", "GET", f"/api/jobs/{made['job']}")).json()
        if state["state"] not in ("queued", "running"):
            break
        await asyncio.sleep(0.25)
    print(f"check by finite elements: {time.perf_counter() - begun:.1f} s", flush=True)


async def load(url: str, users: int, seconds: float) -> Spent:
    """Let users work; return the seconds of each kind of question."""
    spent: Spent = defaultdict(list)
    limits = httpx.Limits(max_connections=4 * users, max_keepalive_connections=2 * users)
    async with httpx.AsyncClient(base_url=url, timeout=60, limits=limits) as client:
        until = time.monotonic() + seconds
        await asyncio.gather(*(user(client, k, until, spent) for k in range(users)))
    return spent


def main() -> None:
    """Measure, and write docs/measured/studio_users.md."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--users", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=60)
    wanted = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, running(Path(folder)) as studio:
        while not httpx.get(f"{studio.url}/api/version").json()["ready"]:
            time.sleep(0.2)
        spent = asyncio.run(load(studio.url, wanted.users, wanted.seconds))
    errors = {what: len(times) for what, times in spent.items() if what.startswith("error")}
    report = Report("studio_users", "Many users of one studio")
    report.say(
        f"{wanted.users} users at once for {wanted.seconds:g} s, clients and server on the same "
        f"machine: {sum(errors.values())} errors."
    )
    report.table(
        ["question", "count", "median, ms", "nine of ten, ms", "worst, ms"],
        [
            [
                what,
                len(t),
                *(f"{1000 * v:.0f}" for v in (np.median(t), np.quantile(t, 0.9), max(t))),
            ]
            for what, t in sorted(spent.items())
            if not what.startswith("error")
        ],
    )
    if errors:
        report.table(["error", "count"], [[what[6:], count] for what, count in errors.items()])
    report.save()


if __name__ == "__main__":
    main()
