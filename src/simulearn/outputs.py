"""Which file endings a result can be written to, and who writes them.

All files are checked before anything is computed: a wrong name should not cost a simulation.
"""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING

from simulearn.errors import Cancel, InputError, stop_if
from simulearn.extras import require
from simulearn.files import replacing
from simulearn.simulate import Progress, Result, write_json, write_npz

if TYPE_CHECKING:
    from simulearn.assembly import Assembled
    from simulearn.show import Camera

Writer = Callable[[Result, Path], None]


def _figure(result: Result, path: Path) -> None:
    from simulearn.show import combined

    picture = combined(result)
    with replacing(path) as temporary:
        picture.savefig(temporary)


def _animation(result: Result, path: Path, cancel: Cancel | None = None) -> None:
    from simulearn.show import animate

    animate(result, path, cancel=cancel)


def _page(result: Result, path: Path) -> None:
    from simulearn.interop import write_html

    write_html(result, path)


def _surface(result: Result, path: Path) -> None:
    from simulearn.interop import write_surface

    write_surface(result, path)


def _morph(result: Result, path: Path) -> None:
    from simulearn.interop import write_morph

    write_morph(result, path)


def _rhino(result: Result, path: Path) -> None:
    from simulearn.interop import write_3dm

    write_3dm(result, path)


def _table(result: Result, path: Path) -> None:
    from simulearn.interop import write_csv

    write_csv(result, path)


def _vtu(result: Result, path: Path) -> None:
    from simulearn.interop import write_vtu

    write_vtu(result, path)


def _pvd(result: Result, path: Path) -> None:
    from simulearn.interop import write_pvd

    write_pvd(result, path)


WRITERS: dict[str, Writer] = {
    ".json": write_json,
    ".npz": write_npz,
    ".csv": _table,
    ".png": _figure,
    ".pdf": _figure,
    ".svg": _figure,
    ".gif": _animation,
    ".html": _page,
    ".mp4": _animation,
    ".webm": _animation,
    ".glb": _surface,
    ".morph.glb": _morph,
    ".3dm": _rhino,
    ".stl": _surface,
    ".obj": _surface,
    ".ply": _surface,
    ".vtu": _vtu,
    ".pvd": _pvd,
}
FILMS = (".mp4", ".webm")
PICTURES = (".png", ".pdf", ".svg")
STRIPS = tuple(f".strip{ending}" for ending in PICTURES)
ASSEMBLED = (
    ".json",
    *PICTURES,
    *STRIPS,
    ".gif",
    *FILMS,
    ".glb",
    ".html",
)  # endings for an assembly
NEEDS = {".html": "nicegui", ".3dm": "rhino3dm", ".vtu": "meshio", ".pvd": "meshio"}


def ending_of(path: Path, known: Iterable[str] = WRITERS) -> str:
    """Return the ending that a file's name has, the longest one that is known.

    Args:
        path: the file; capitals count as small letters.
        known: endings, each with its point.

    Raises:
        InputError: the name has none of them.
    """
    name = path.name.lower()
    found = [ending for ending in known if name.endswith(ending) and name != ending]
    if not found:
        raise InputError(f"{path}: the ending is not one of {' '.join(known)}")
    return max(found, key=len)


def check(paths: Sequence[Path], grid: Path | None = None, known: Iterable[str] = WRITERS) -> None:
    """Make sure that a result can be written to these files.

    Args:
        paths: the files.
        grid: the file that the design comes from, which no result may replace.
        known: endings that there are: of a result, or of an assembly.

    Raises:
        InputError: an ending is unknown, a package is missing, or a place cannot be written.
    """
    for path in paths:
        check_package(path, ending_of(path, known))
        check_place(path, [grid] if grid is not None else [])


def check_package(path: Path, ending: str) -> None:
    """Make sure that what writes a file is installed.

    Args:
        path: the file.
        ending: its ending.

    Raises:
        InputError: a package or program is missing; the message says how to install it.
    """
    if ending in NEEDS:
        require(f"{path}: needs", NEEDS[ending])
    if ending in FILMS:
        from simulearn.show.video import ffmpeg

        try:
            ffmpeg()
        except InputError as error:
            raise InputError(f"{path}: {error}", error.code) from error


def check_place(path: Path, sources: Sequence[Path] = ()) -> None:
    """Make sure that a file can be written.

    Args:
        path: the file.
        sources: files that are read, which it may not replace.

    Raises:
        InputError: it is a folder or a source, or its folder does not exist or is not writable.
    """
    if path.is_dir():
        raise InputError(f"{path}: is a folder; name a file")
    if not path.parent.is_dir():
        raise InputError(f"{path}: the folder {path.parent} does not exist")
    for source in sources:
        if source.exists() and path.exists() and path.samefile(source):
            raise InputError(f"{path}: is what is read; name another file for the result")
    try:  # trying is the only test that holds for root and odd file systems, too
        with TemporaryFile(dir=path.parent):
            pass
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error


def write(result: Result, path: Path, cancel: Cancel | None = None) -> None:
    """Write a result in the format of the file's ending.

    Args:
        result: what to write.
        path: the file.
        cancel: stops an animation; all else takes less time.

    Raises:
        InputError: the file cannot be written.
        CancelledError: the token was set.
    """
    stop_if(cancel)
    writer = WRITERS[ending_of(path)]
    if writer is _animation:
        _animation(result, path, cancel)
    else:
        writer(result, path)


def write_assembled(
    assembled: "Assembled",
    path: Path,
    camera: "Camera | None" = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> None:
    """Write an assembly in the format of the file's ending, one of ASSEMBLED.

    Args:
        assembled: what to write.
        path: the file.
        camera: where the viewer of pictures is; None: where it usually is.
        progress: of an animation: called with the pictures done and the pictures in all.
        cancel: stops it.

    Raises:
        InputError: the file cannot be written.
        CancelledError: the token was set.
    """
    stop_if(cancel)
    ending = ending_of(path, ASSEMBLED)
    if ending == ".json":
        from simulearn.assembly import write_assembled_json

        write_assembled_json(assembled, path)
        return
    if ending == ".glb":
        from simulearn.interop import write_assembled as write_scene

        write_scene(assembled, path, cancel)
        return
    from simulearn.show import assembly as show

    seen = camera or show.CAMERA
    if ending == ".html":
        from simulearn.interop import write_assembled_html

        write_assembled_html(assembled, path, seen, cancel)
        return
    if ending not in (*PICTURES, *STRIPS):
        show.animate_assembly(assembled, path, seen, progress=progress, cancel=cancel)
        return
    draw = show.strip if ending in STRIPS else show.assembled_picture
    picture = draw(assembled, camera=seen)
    with replacing(path) as temporary:
        picture.savefig(temporary)
