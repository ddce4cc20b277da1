"""One figure for a result: the flat design beside the shape that it takes."""

from pathlib import Path

from matplotlib.figure import Figure

from simulearn.files import replacing
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.deformed import dimensions, draw_ghost, draw_skin, draw_triad, extent
from simulearn.show.flat import draw_flat
from simulearn.simulate import Result, skin


def figure(
    result: Result, frame: int = -1, camera: Camera = Camera(), width: float = 7.2
) -> Figure:
    """Return the flat design beside a frame, both at their own scale.

    Args:
        result: what to show.
        frame: which frame; the last by default.
        camera: where the viewer is.
        width: of the figure, inches.
    """
    with style.paper():
        surface = skin(result)
        low, high = extent(surface, camera, [0, frame])
        left, foot = 0.42 * width, 0.72
        panes = [left, width - left]
        fig = Figure(dpi=style.DPI)
        flat_ax, ax = fig.add_axes((0, 0, 1, 1)), fig.add_axes((0, 0, 1, 1))
        corners = draw_flat(flat_ax, result.grid)
        draw_ghost(ax, surface, camera)
        draw_skin(ax, surface.vertices[frame], surface, result.grid.fixed, camera)

        boxes = [corners, (low, high)]
        margins = [0.06 * float(max(b - a)) for a, b in boxes]
        scales = [
            (b[0] - a[0] + 2 * m) / pane
            for (a, b), m, pane in zip(boxes, margins, panes, strict=True)
        ]
        heights = [
            (b[1] - a[1] + 2 * m) / scale
            for (a, b), m, scale in zip(boxes, margins, scales, strict=True)
        ]
        tall = max(heights)
        height = tall + foot
        fig.set_size_inches(width, height)
        for axes, x, pane, own, (a, b), m in zip(
            (flat_ax, ax), (0, left), panes, heights, boxes, margins, strict=True
        ):
            bottom = foot + (tall - own) / 2
            axes.set_position((x / width, bottom / height, pane / width, own / height))
            style.bare(axes, a, b, m)
            scale = (b[0] - a[0] + 2 * m) / pane  # mm in an inch
            floor = a[1] - m - (bottom - 0.42) * scale
            style.scale_bar(axes, a[0], floor, style.nice_length(float(b[0] - a[0])))
            if axes is ax:
                draw_triad(ax, b[0] - 0.3 * scale, floor + 0.05 * scale, 0.24 * scale, camera)
        fig.text(
            (left + 0.53 * panes[1]) / width,
            0.4 / height,
            dimensions(result),
            ha="center",
            fontsize=7,
        )
        style.legend(fig, (width - style.LEGEND_WIDTH) / 2 + 0.1, 0.12)
    return fig


def save_figure(result: Result, path: Path | str) -> None:
    """Write the figure of a result.

    Raises:
        InputError: the file cannot be written.
    """
    picture = figure(result)
    with replacing(path) as temporary:
        picture.savefig(temporary, facecolor="white")
