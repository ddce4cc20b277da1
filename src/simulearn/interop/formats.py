"""Where a result can go: the ending of a file's name picks the format.

All of this module is cheap to import; what a format needs is loaded when it is written.
"""

import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from simulearn.errors import InputError
from simulearn.simulate import Result, write_json, write_npz

Writer = Callable[[Result, Path], None]


def _figure(name: str) -> Writer:
    def write(result: Result, path: Path) -> None:
        from simulearn import show
        from simulearn.files import replacing

        figure = show.flat(result.grid) if name == "flat" else getattr(show, name)(result)
        with replacing(path) as temporary:
            figure.savefig(temporary)

    return write


def _animation(result: Result, path: Path) -> None:
    from simulearn.show import animate

    animate(result, path)


def _glb(result: Result, path: Path) -> None:
    from simulearn.interop.mesh import write_glb

    write_glb(result, path)


def _stl(result: Result, path: Path) -> None:
    from simulearn.interop.mesh import write_stl

    write_stl(result, path)


def _vtu(result: Result, path: Path) -> None:
    from simulearn.interop.vtk import write_vtu

    write_vtu(result, path)


def _pvd(result: Result, path: Path) -> None:
    from simulearn.interop.vtk import write_pvd

    write_pvd(result, path)


def _vtk_ready(path: Path) -> None:
    from simulearn.interop.vtk import check_series, require_meshio

    require_meshio()
    if path.suffix.lower() == ".pvd":
        check_series(path)


@dataclass(frozen=True)
class Format:
    """A way of writing results.

    Attributes:
        what: what such a file holds.
        write: writes a result to a path.
        check: raises InputError if the format cannot be written there.
    """

    what: str
    write: Writer
    check: Callable[[Path], None] = lambda path: None


FORMATS: dict[str, Format] = {
    ".json": Format("joints and beams of all frames", write_json),
    ".npz": Format("all there is, as NumPy arrays", write_npz),
    ".flat.png": Format("picture of the flat grid", _figure("flat")),
    ".deformed.png": Format("picture of the last frame", _figure("deformed")),
    ".png": Format("picture of both", _figure("combined")),
    ".pdf": Format("the same, for print", _figure("combined")),
    ".svg": Format("the same, for the web", _figure("combined")),
    ".gif": Format("animation of the frames", _animation),
    ".glb": Format("coloured mesh of the last frame and the flat grid", _glb),
    ".stl": Format("closed surface of the last frame", _stl),
    ".vtu": Format("solid of the last frame, for ParaView", _vtu, _vtk_ready),
    ".pvd": Format("solids of all frames, for ParaView", _pvd, _vtk_ready),
}


def format_of(path: Path) -> Format:
    """Return the format that a file's ending stands for.

    Raises:
        InputError: there is none; the message lists the endings.
    """
    for ending, found in FORMATS.items():  # the longer endings come first
        if path.name.lower().endswith(ending) and len(path.name) > len(ending):
            return found
    raise InputError(f"{path}: no format has this ending; there are {' '.join(FORMATS)}")


def check_outputs(paths: Iterable[Path]) -> None:
    """Make sure, before anything is computed, that results can be written to all paths.

    Raises:
        InputError: an ending is unknown, a folder is missing or closed, a package is missing.
    """
    seen: set[Path] = set()
    for path in paths:
        found = format_of(path)
        if path.is_dir():
            raise InputError(f"{path}: is a folder; name a file")
        if not path.parent.is_dir():
            raise InputError(f"{path}: the folder {path.parent} does not exist")
        if path.resolve() in seen:
            raise InputError(f"{path}: is named twice")
        seen.add(path.resolve())
        try:
            # Only trying tells: access rights do not know of full or read-only disks.
            with tempfile.TemporaryFile(dir=path.parent):
                pass
        except OSError as error:
            raise InputError(f"{path}: cannot be written ({error.strerror})") from error
        found.check(path)


def write(result: Result, path: Path) -> None:
    """Write a result, whole or not at all, in the format of the file's ending.

    Raises:
        InputError: the ending is unknown, or the file cannot be written.
    """
    format_of(path).write(result, path)
