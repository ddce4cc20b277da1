"""Small tilings, and workers that are this very process."""

import hashlib
import os
import subprocess
import sys
import time
from concurrent.futures import Future
from contextlib import contextmanager

import numpy as np

from simulearn.dataset.workers import Workers
from simulearn.grid import grid_to_dict, lattice
from simulearn.tile import from_chart, heights, revolution
from simulearn.tile.searching import ModuleAnswer, run

RING = {"schema": "simulearn.chart/1", "revolution": {"profile": [[80, 0], [78, 50]]}}


def ring(count=10, cells=(1, 1)):
    """A ring of modules of one row."""
    return from_chart(revolution(RING["revolution"]["profile"]), (count, 1), cells)


@contextmanager
def here(work=run, seen=None):
    """Workers that answer at once, in this process; `seen` gets the jobs."""

    def submit(job):
        if seen is not None:
            seen.append(job)
        future = Future()
        try:
            future.set_result(work(job))
        except Exception as error:
            future.set_exception(error)
        return future

    yield Workers(submit, lambda: 1)


def pretended(job):
    """Answer a job without simulating: half a millimetre off at first, a tenth later."""
    seed = int.from_bytes(hashlib.sha256(job.key.encode()).digest()[:4], "big")
    off = 0.5 if job.grid is None else 0.1
    targets = np.array(job.targets)
    joints = targets + off * np.random.default_rng(seed).uniform(-1, 1, targets.shape)
    grid = lattice(job.cells, 50.0)
    middles = joints[grid.beams].mean(axis=1)
    return ModuleAnswer(
        grid_to_dict(grid),
        joints.tolist(),
        np.repeat(middles[:, None], 3, axis=1).tolist(),
        np.zeros((len(joints) + len(middles), 3)).tolist(),
        True,
        off,
        off,
    )


def slowly(job):
    """Answer as pretended, after a while in which one can be killed."""
    time.sleep(0.1)
    return pretended(job)


def wavy():
    """A patch of six modules that are all different."""
    chart = heights(
        lambda x, y: 25 * np.cos(x / 90 + 0.3) * np.cos(y / 80), (-90.0, 90.0), (-60.0, 60.0)
    )
    return from_chart(chart, (3, 2), (1, 1))


def command(*words):
    """Start the command line in a process group of its own."""
    return subprocess.Popen(
        [sys.executable, "-m", "simulearn.cli", *map(str, words)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
        env={**os.environ, "COLUMNS": "200"},
    )
