"""Pictures of inverse and hybrid design: errors, targets beside shapes, changes, suggestions."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.inverse.keeping import ROBUST, Step
from simulearn.inverse.ranking import Ranking, Suggestion
from simulearn.show import style
from simulearn.show.animation import PAUSE, write_gif
from simulearn.show.camera import Camera
from simulearn.show.deformed import draw_deformed, draw_skin, draw_triad, qualified
from simulearn.show.deformed import extent as extent_deformed
from simulearn.show.flat import draw_flat
from simulearn.show.flat import extent as extent_flat
from simulearn.show.targets import TARGET, draw_goals, draw_sets, extents, placed, region
from simulearn.simulate import Result, skin

Array = NDArray[np.float64]

SPACING = 3.0  # mm, length of the quadrilaterals along a beam
EACH = 220  # ms that a design is shown


def error_curve(steps: Sequence[Step], error_fea_mm: float | None = None) -> Figure:
    """Return the error of the best design against iterations and against designs.

    Args:
        steps: of a search.
        error_fea_mm: of its answer by finite elements.
    """
    figure = Figure(figsize=(7.2, 2.7), dpi=style.DPI, layout="constrained")
    axes = figure.subplots(1, 2, sharey=True)
    # A search that reached its target exactly still has a place on the scale.
    errors = [max(step.error_mm, 1e-3) for step in steps]
    for ax, name, label in (
        (axes[0], "iteration", "iteration"),
        (axes[1], "designs", "designs simulated"),
    ):
        at = [getattr(step, name) for step in steps]
        ax.step(at, errors, where="post", color=style.INK, lw=1.2)
        ax.set_xlabel(label, fontsize=8)
        for a, b in pairwise(steps):
            if a.phase != b.phase:
                ax.axvline(getattr(b, name), color=TARGET, lw=0.7, ls=":")
        if error_fea_mm is not None:
            ax.plot(at[-1], error_fea_mm, "o", color=TARGET, ms=4, clip_on=False)
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter("{x:g}")
        ax.yaxis.set_minor_formatter("")
        ax.grid(axis="y", lw=0.3, color=style.GHOST_LINE)
        ax.spines[["top", "right"]].set_visible(False)
        ax.tick_params(which="both", labelsize=7)
    axes[0].set_ylabel("fitting error, mm", fontsize=8)
    end = f"{steps[0].error_mm:.1f} mm to {steps[-1].error_mm:.2f} mm"
    end += " expected of prints" if steps[-1].phase == ROBUST else ""
    checked = "" if error_fea_mm is None else f"; by finite elements {error_fea_mm:.2f} mm (dot)"
    axes[0].set_title(end + checked, fontsize=8, loc="left")
    return style.ink(figure)


def wanted(
    result: Result, goals: Goals, error_mm: float, camera: Camera = Camera(), width: float = 5.2
) -> Figure:
    """Return the picture of a shape beside its targets.

    Args:
        result: the shape.
        goals: what was wanted.
        error_mm: of the shape.
        camera: where the viewer is.
        width: of the figure, inches.
    """
    points = _points(result, goals)
    surface = placed(skin(result, SPACING), goals, points)
    box = region([surface])
    low, high = _around([extent_deformed(surface, camera, [0, -1])], goals, box, camera)
    fig = Figure(figsize=(width, width), dpi=style.DPI)
    ax, inch = style.footed(fig, low, high)
    draw_sets(ax, goals, box, camera)
    draw_deformed(ax, result, surface, -1, camera)
    draw_goals(ax, goals, points, camera)
    draw_triad(ax, high[0] - 0.2 * inch, low[1] - 0.15 * inch, 0.22 * inch, camera)
    what = "targets" if {*goals.kinds} == {"point"} else "goals"
    style.words(fig, f"{len(goals)} {what}, mean distance {error_mm:.2f} mm ({result.engine})")
    style.remark(fig, qualified(result))
    style.legend(fig)
    return style.ink(fig)


def changing(
    results: Sequence[Result],
    steps: Sequence[Step],
    goals: Goals,
    path: Path | str,
    camera: Camera = Camera(),
    width: float = 7.2,
    dpi: int = 100,
) -> None:
    """Write the animation of a search: the flat design and its shape, iteration by iteration.

    Args:
        results: shapes of the best designs, in their order.
        steps: the iterations that they come from.
        goals: what is wanted.
        path: of the GIF.
        camera: where the viewer of the shapes is.
        width: of the pictures, inches.
        dpi: their pixels per inch.
    """
    points = [_points(result, goals) for result in results]
    surfaces = [placed(skin(r, SPACING), goals, p) for r, p in zip(results, points, strict=True)]
    box = region(surfaces)
    flats = [extent_flat(result.grid) for result in results]
    left = _union(flats)
    right = _around([extent_deformed(s, camera, [-1]) for s in surfaces], goals, box, camera)
    at, low, high = _beside(left, right)
    pictures = []
    for result, step, surface, here in zip(results, steps, surfaces, points, strict=True):
        fig = Figure(figsize=(width, width), dpi=dpi)
        canvas = FigureCanvasAgg(fig)
        ax, _ = style.footed(fig, low, high)
        draw_flat(ax, result.grid, False, at)
        draw_sets(ax, goals, box, camera)
        draw_skin(ax, surface.vertices[-1], surface, result.grid.fixed, camera)
        draw_goals(ax, goals, here, camera)
        style.words(fig, f"iteration {step.iteration}: {step.error_mm:.2f} mm")
        style.legend(fig)
        style.ink(fig)
        canvas.draw()
        pictures.append(np.array(canvas.buffer_rgba())[..., :3])
    write_gif(pictures, [PAUSE, *[EACH] * (len(pictures) - 2), 2 * PAUSE][-len(pictures) :], path)


def cards(
    ranking: Ranking, results: Sequence[Result], goals: Goals | None, camera: Camera = Camera()
) -> Figure:
    """Return the suggestions of a ranking as cards: change, predicted error, plan and shape.

    Args:
        ranking: whose suggestions.
        results: of their grids.
        goals: what is wanted, if anything.
        camera: where the viewer of the shapes is.
    """
    pairs = zip(results, ranking.best, strict=True)
    surfaces = [placed(skin(result, SPACING), goals, one.points) for result, one in pairs]
    box = region(surfaces)
    plans = _union([extent_flat(result.grid) for result in results])
    shapes = _around([extent_deformed(s, camera, [-1]) for s in surfaces], goals, box, camera)
    across = max(float(b[0] - a[0]) for a, b in (plans, shapes))
    tall = [float(b[1] - a[1]) / across for a, b in (plans, shapes)]
    count, width = len(results), 1.75
    size = (width * count, width * (sum(tall) + 0.1) + 0.95)
    fig = Figure(figsize=size, dpi=style.DPI)
    for k, (one, result, surface) in enumerate(zip(ranking.best, results, surfaces, strict=True)):
        top = 1 - 0.48 / size[1]
        for (low, high), height in zip((plans, shapes), tall, strict=True):
            share = width * height / size[1]
            ax = fig.add_axes(((k + 0.04) / count, top - share, 0.92 / count, share))
            middle = (low + high)[0] / 2
            ax.set_xlim(middle - across / 2, middle + across / 2)
            ax.set_ylim(low[1], high[1])
            ax.set_aspect("equal")
            ax.axis("off")
            top -= share + 0.1 * width / size[1]
            if ax is fig.axes[2 * k]:
                draw_flat(ax, result.grid, False)
                _mark(ax, one, ranking.grid)
            else:
                if goals is not None:
                    draw_sets(ax, goals, box, camera)
                draw_skin(ax, surface.vertices[-1], surface, result.grid.fixed, camera)
                if goals is not None:
                    draw_goals(ax, goals, one.points, camera, 3.5)
        x = (k + 0.06) / count
        fig.text(x, 1 - 0.14 / size[1], f"{k + 1}  {one.change.words}", fontsize=7, va="center",
                 fontweight="bold")  # fmt: skip
        fig.text(x, 1 - 0.32 / size[1], _promise(ranking, one, goals), fontsize=7, va="center")
    style.legend(fig)
    return style.ink(fig)


def _promise(ranking: Ranking, one: Suggestion, goals: Goals | None) -> str:
    if goals is None:
        return f"moves the joints by {one.moved_mm:.1f} mm"
    return f"{ranking.error_mm:.1f} → {one.error_mm:.1f} mm"


def _mark(ax: Axes, one: Suggestion, before: Grid) -> None:
    """Ring the joints or beams that a suggestion changes; joints with where they were."""
    after = one.grid
    for k in one.change.indices:
        if one.change.part == "joint":
            (x, y), (u, v) = before.joints[k], after.joints[k]
            ax.plot([x, u], [y, v], color=TARGET, lw=1.2, zorder=6)
            ax.plot(x, y, "o", ms=2.5, color=TARGET, zorder=6)
        else:
            u, v = after.joints[after.beams[k]].mean(axis=0)
        ax.plot(u, v, "o", ms=11, mfc="none", mew=1.2, color=TARGET, zorder=6, clip_on=False)


def _points(result: Result, goals: Goals) -> Array:
    return goals.points(result.joints[-1], result.beams[-1])


def _around(
    shapes: Sequence[tuple[Array, Array]], goals: Goals | None, box: Array, camera: Camera
) -> tuple[Array, Array]:
    """Return the lower left and upper right corner (2,) of shapes and targets together."""
    return _union(shapes if goals is None else [*shapes, extents(goals, box, camera)])


def _union(extents: Sequence[tuple[Array, Array]]) -> tuple[Array, Array]:
    low, high = zip(*extents, strict=True)
    return np.min(low, axis=0), np.max(high, axis=0)


def _beside(
    left: tuple[Array, Array], right: tuple[Array, Array]
) -> tuple[tuple[float, float], Array, Array]:
    """Return where the left picture goes, its middle at the right one's height, and the corners."""
    gap = 0.1 * float(right[1][0] - right[0][0])
    at = np.array(
        [right[0][0] - gap - left[1][0], (right[0] + right[1] - left[0] - left[1])[1] / 2]
    )
    corners = np.array([left[0] + at, left[1] + at, *right])
    return (float(at[0]), float(at[1])), corners.min(axis=0), corners.max(axis=0)
