"""Covering a surface with modules: patches, tasks that share borders, what is alike."""

from simulearn.tile.alike import Member, alike
from simulearn.tile.borders import Fit
from simulearn.tile.chartfile import chart_from_dict, read_chart
from simulearn.tile.charts import Chart
from simulearn.tile.patches import Tiling, from_chart
from simulearn.tile.quads import from_quads
from simulearn.tile.running import tile
from simulearn.tile.shapes import between, heights, interpolated, revolution
from simulearn.tile.source import read_tiling
from simulearn.tile.tiled import Settings, Stage, Tiled
from simulearn.tile.unrolling import unrolled

__all__ = [
    "Chart",
    "Fit",
    "Member",
    "Settings",
    "Stage",
    "Tiled",
    "Tiling",
    "alike",
    "between",
    "chart_from_dict",
    "from_chart",
    "from_quads",
    "heights",
    "interpolated",
    "read_chart",
    "read_tiling",
    "revolution",
    "tile",
    "unrolled",
]
