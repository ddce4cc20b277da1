"""A tiling that is killed in the middle of its rounds comes to the same answer afterwards."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from modules import here, pretended, wavy

from simulearn.tile import Settings, tile

SETTINGS = Settings(gap_mm=0.05, rounds=2)
SCRIPT = """
import sys
from modules import here, slowly, wavy
from simulearn.tile import Settings, tile
tile(wavy(), Settings(gap_mm=0.05, rounds=2), sys.argv[1], here(slowly))
"""


def test_what_was_killed_goes_on_to_the_same_answer(tmp_path):
    whole = tile(wavy(), SETTINGS, None, here(pretended))
    places = [str(Path(__file__).parent), *sys.path]
    killed = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(tmp_path)],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(places)},
    )
    work, until = tmp_path / "work", time.monotonic() + 300
    enough = 1 + len(whole.grids)  # so that the second round has begun
    while time.monotonic() < until and killed.poll() is None:
        if len(list(work.glob("[!.]*.json"))) >= enough:
            break
        time.sleep(0.01)
    killed.send_signal(signal.SIGKILL if hasattr(signal, "SIGKILL") else signal.SIGTERM)
    killed.wait()
    kept = {path.name for path in work.glob("[!.]*.json")}
    assert len(kept) >= enough
    seen = []
    after = tile(wavy(), SETTINGS, tmp_path, here(pretended, seen))
    assert len(seen) > 0
    assert not kept & {f"{job.key}.json" for job in seen}
    assert after.rounds == whole.rounds
    assert after.fit.gap_mm == whole.fit.gap_mm
    for one, other in zip(after.grids, whole.grids, strict=True):
        np.testing.assert_array_equal(one.joints, other.joints)
        np.testing.assert_array_equal(one.actuators, other.actuators)
    np.testing.assert_array_equal(after.fit.versions, whole.fit.versions)
