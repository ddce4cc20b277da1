"""The prints that tests of print files share: on each printer three grids, and two on one bed."""

from functools import cache

from simulearn.fabricate import load_printer, prepare
from simulearn.grid import make

FIRMWARE = {
    "bambu-x1": "bambu",
    "ender-3": "marlin",
    "makerbot-2x": "sailfish",
    "modix-big60": "reprap",
    "prusa-mk4": "prusa",
    "stacker-s4": "marlin",
    "voron": "klipper",
}
GRIDS = {
    "cone": ([make("cone")], ["cone"]),
    "twist": ([make("twist", (2, 2), 40.0)], ["twist"]),
    "wave": ([make("wave", (2, 3), 40.0)], ["wave"]),
    "two": (
        [make("dome", (1, 1), 30.0), make("bowl", (1, 1), 30.0)],
        ['a "dome" #1', "A (dome) 1"],
    ),
}


def machine(name):
    """Return a printer with the firmware that its maker gives it."""
    return load_printer(name).model_copy(update={"firmware": FIRMWARE[name]})


@cache
def job_of(printer, grids):
    """Return a print by the names of its printer and of its grids."""
    return prepare(GRIDS[grids][0], machine(printer), GRIDS[grids][1])
