"""The prints that tests of print files share: on each printer three grids, and two on one bed."""

from functools import cache

from simulearn.fabricate import load_printer, prepare, printers
from simulearn.grid import make

FIRMWARE = {name: load_printer(name).firmware for name in printers()}
GRIDS = {
    "cone": ([make("cone")], ["cone"]),
    "twist": ([make("twist", (2, 2), 40.0)], ["twist"]),
    "wave": ([make("wave", (2, 3), 40.0)], ["wave"]),
    "two": (
        [make("dome", (1, 1), 30.0), make("bowl", (1, 1), 30.0)],
        ['a "dome" #1', "A (dome) 1"],
    ),
}


@cache
def job_of(printer, grids):
    """Return a print by the names of its printer and of its grids."""
    return prepare(GRIDS[grids][0], load_printer(printer), GRIDS[grids][1])
