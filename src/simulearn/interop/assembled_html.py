"""An assembly as one HTML file that plays its order in any browser, without a network.

The scene is the glTF file of `assembled`, and the page adds what plays it and what is to be known.
"""

from pathlib import Path

from simulearn.assembly import Assembled
from simulearn.errors import Cancel
from simulearn.files import replacing
from simulearn.interop.assembled import scene_of
from simulearn.interop.html import filled
from simulearn.interop.morphing import PAUSE
from simulearn.interop.surface import Y_UP
from simulearn.show.assembly import assembled_picture
from simulearn.show.camera import Camera

SCHEMA = "simulearn.assembly-page/1"


def write_assembled_html(
    assembled: Assembled, path: Path | str, camera: Camera, cancel: Cancel | None = None
) -> None:
    """Write an assembly as a page that plays offline.

    Args:
        assembled: what to write; parts without a result are left out, and named.
        path: the file.
        camera: where the viewer is at first.
        cancel: stops it between two parts.

    Raises:
        InputError: the package with three.js is not installed, or the file cannot be written.
        CancelledError: the token was set.
    """
    assembly, moments = assembled.assembly, assembled.timeline
    begins = [float(moments.times[moments.of_step(k)[0]]) for k in range(len(assembly.order))]
    titles = [step.title for step in assembly.order]
    names = [part.name for _, part, _ in assembled.present]
    contents = {
        "schema": SCHEMA,
        "engine": assembled.engine,
        "pause": PAUSE,
        "towards": (Y_UP @ camera.axes[2]).tolist(),
        "steps": [
            {"name": title, "begins": begin} for title, begin in zip(titles, begins, strict=True)
        ],
        "parts": names,
        "collisions": [one.words for one in assembled.collisions],
        "warnings": [
            *(f"{name}: {failure.message}" for name, failure in assembled.failures.items()),
            *(message.message for message in assembled.warnings),
        ],
    }
    picture = assembled_picture(assembled, camera)
    words = f"{len(names)} parts put together: {', '.join(titles)}"
    title = assembly.name or Path(path).stem
    text = filled("assembled.js", title, contents, scene_of(assembled, cancel), picture, words)
    with replacing(path) as temporary:
        temporary.write_bytes(text.encode("utf-8"))
