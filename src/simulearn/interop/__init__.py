"""Results as files of other programs: surfaces, solids, tables, and pages that play in a browser.

Each name is imported when it is first used, since most of them load libraries of their own.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from simulearn.interop.assembled import write_assembled as write_assembled
    from simulearn.interop.assembled_html import write_assembled_html as write_assembled_html
    from simulearn.interop.html import write_html as write_html
    from simulearn.interop.morphing import write_morph as write_morph
    from simulearn.interop.surface import write_surface as write_surface
    from simulearn.interop.table import write_csv as write_csv
    from simulearn.interop.threedm import write_3dm as write_3dm
    from simulearn.interop.threedm import write_job_3dm as write_job_3dm
    from simulearn.interop.vtk import write_pvd as write_pvd
    from simulearn.interop.vtk import write_vtu as write_vtu

PLACES = {  # name -> module
    "write_3dm": "threedm",
    "write_assembled": "assembled",
    "write_assembled_html": "assembled_html",
    "write_csv": "table",
    "write_html": "html",
    "write_job_3dm": "threedm",
    "write_morph": "morphing",
    "write_pvd": "vtk",
    "write_surface": "surface",
    "write_vtu": "vtk",
}

__all__ = [
    "write_3dm",
    "write_assembled",
    "write_assembled_html",
    "write_csv",
    "write_html",
    "write_job_3dm",
    "write_morph",
    "write_pvd",
    "write_surface",
    "write_vtu",
]


def __getattr__(name: str) -> Any:
    if name in PLACES:
        return getattr(import_module(f"{__name__}.{PLACES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
