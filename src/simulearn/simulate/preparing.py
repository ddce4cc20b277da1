"""The first time on a machine: kernels of the learned engine, compiled by two processes.

The compiler works on one kernel at a time in a process. So another process compiles those of
networks and collisions while this one compiles those of mechanics; each keeps them on disk, where
the other finds them.
"""

import os
import subprocess
import sys
from contextlib import suppress
from functools import cache
from multiprocessing import parent_process
from pathlib import Path
from typing import TYPE_CHECKING

from simulearn.collisions import find_all
from simulearn.files import cores
from simulearn.grid import make
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.model import Designs, Model
from simulearn.simulate.designs import designs_of

# What loads the compiler is imported where it is used: quick commands do without.

if TYPE_CHECKING:
    from simulearn.learn.equilibrium.model import Equilibrium

LONGEST = 300.0  # s, after which the other process is not waited for


def prepare(model: Model) -> None:
    """Compile all kernels of a model's predictions that are not kept on disk."""
    from simulearn.learn.equilibrium.model import Equilibrium

    if isinstance(model, Equilibrium):  # others have their own
        _prepare()


@cache
def _prepare() -> None:
    if _all_kept():
        return
    other = _begun()
    try:
        _model().rollout(_small())
        if other is not None:
            with suppress(subprocess.TimeoutExpired):  # the rest is compiled where it is needed
                other.wait(LONGEST)
    finally:
        if other is not None:
            other.kill()
            other.wait()


def _all_kept() -> bool:
    from simulearn.collisions.kernels.pairs import find_pairs
    from simulearn.learn.equilibrium.kernels.network import outputs
    from simulearn.mechanics.kernels.path import follow
    from simulearn.native import is_kept

    return all(map(is_kept, (find_pairs, outputs, follow)))


def rest() -> None:
    """Compile all kernels but those that find equilibria."""
    from simulearn.learn.equilibrium.native import predict, unsolved

    designs = _small()
    frames = predict(_model().parameters, designs, solve=unsolved)
    find_all(frames.joints, frames.sections, designs.beams, designs.actuators)


def _model() -> "Equilibrium":
    from simulearn.learn.equilibrium.model import Equilibrium

    model = bundle_of("default").model
    assert isinstance(model, Equilibrium)
    return model


def _small() -> Designs:
    return designs_of([make("flat", (1, 1), 50.0)], _model().material)


def _begun() -> "subprocess.Popen[bytes] | None":
    """Return the other process, None where it would not help or cannot be started."""
    interpreter = Path(sys.executable or "")
    # Programs that hold an interpreter name themselves; workers are as many as there are cores.
    if cores() < 2 or not interpreter.stem.startswith("python") or parent_process() is not None:
        return None
    command = [str(interpreter), "-c", f"from {__name__} import rest; rest()"]
    path = os.pathsep.join(filter(None, sys.path))
    quiet = subprocess.DEVNULL
    with suppress(OSError, ValueError):
        return subprocess.Popen(
            command,
            env={**os.environ, "PYTHONPATH": path},
            stdin=quiet,
            stdout=quiet,
            stderr=quiet,
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
    return None
