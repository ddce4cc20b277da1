"""Several morphed grids put together in space, as one picture."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulearn.rigid import Place
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.deformed import draw_skin, draw_triad, extent
from simulearn.simulate import Result, Skin, skin

Array = NDArray[np.float64]
SPACING = 4.0  # mm, length of the quadrilaterals along a beam


def joined(parts: Sequence[tuple[Result, Place]]) -> Skin:
    """Return the surfaces of the last frames of all parts in their places, as one."""
    skins = [skin(result, SPACING) for result, _ in parts]
    begins = np.cumsum([0, *(surface.vertices.shape[1] for surface in skins)])
    return Skin(
        vertices=np.concatenate(
            [place(s.vertices[-1]) for s, (_, place) in zip(skins, parts, strict=True)]
        )[None],
        quads=np.concatenate([s.quads + k for s, k in zip(skins, begins, strict=False)]),
        ratio=np.concatenate([s.ratio for s in skins]),
        joint=np.concatenate([s.joint for s in skins]),
        sharp=np.concatenate([s.sharp for s in skins]),
    )


def assembly(
    parts: Sequence[tuple[Result, Place]],
    text: str,
    camera: Camera = Camera(azimuth=-62.0, elevation=18.0),
    width: float = 5.2,
) -> Figure:
    """Return the picture of parts put together.

    Args:
        parts: results and where they go.
        text: words beneath.
        camera: where the viewer is.
        width: of the figure, inches.
    """
    surface = joined(parts)
    low, high = extent(surface, camera, [0])
    fig = Figure(figsize=(width, width), dpi=style.DPI)
    ax, inch = style.footed(fig, low, high)
    draw_skin(ax, surface.vertices[0], surface, parts[0][0].grid.fixed, camera)
    draw_triad(ax, high[0] - 0.1 * inch, low[1] - 0.1 * inch, 0.2 * inch, camera)
    style.words(fig, text)
    style.legend(fig)
    return style.ink(fig)
