"""The picture of several answers: each as a card, and what one gives up for another.

Below the cards the error stands against the length of the actuators and against the time of the
print; a line joins the answers that no other beats in both. Numbers are those of the cards.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulearn.inverse.front import Answer, non_dominated
from simulearn.inverse.goals import Goals
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.deformed import draw_skin
from simulearn.show.deformed import extent as extent_deformed
from simulearn.show.flat import draw_flat
from simulearn.show.flat import extent as extent_flat
from simulearn.show.inverse import SPACING
from simulearn.show.targets import TARGET, draw_goals, draw_sets, extents, placed, region
from simulearn.simulate import Result, skin

Array = NDArray[np.float64]
Corners = tuple[Array, Array]  # lower left and upper right, (2,) mm

LEAST, WIDE = 5, 1.75  # cards in a row whose width is left for charts; inches of a card
MARGIN = 0.02  # of what is drawn on a card
HEAD, GAP, CHART, FOOT = 0.78, 0.2, 2.3, 0.45  # inches


def answers_figure(
    answers: Sequence[Answer],
    shapes: Sequence[Result | None],
    goals: Goals,
    camera: Camera = Camera(),
) -> Figure:
    """Return the picture of several answers.

    Args:
        answers: the best first.
        shapes: of them; None where there is none.
        goals: what is wanted.
        camera: where the viewer of the shapes is.
    """
    points = {
        k: goals.points(shape.joints[-1], shape.beams[-1])
        for k, shape in enumerate(shapes)
        if shape is not None
    }
    skins = {
        k: placed(skin(shape, SPACING), goals, points[k])
        for k, shape in enumerate(shapes)
        if shape is not None
    }
    drawn = list(skins.values())
    box = region(drawn) if drawn else np.zeros((2, 3))
    plans = _union([extent_flat(one.grid.centred) for one in answers])
    seen = [extent_deformed(surface, camera, [-1]) for surface in drawn]
    morphed = _union([*seen, extents(goals, box, camera)])
    across = max(float(high[0] - low[0]) for low, high in (plans, morphed))
    tall = [WIDE * float(high[1] - low[1]) / across for low, high in (plans, morphed)]
    width = WIDE * max(LEAST, len(answers))
    fig = Figure(figsize=(width, HEAD + sum(tall) + GAP + CHART + FOOT), dpi=style.DPI)
    for k, one in enumerate(answers):
        _head(fig, k, one)
        draw_flat(_panel(fig, k, HEAD, tall[0], plans, across), one.grid.centred, False)
        if k in skins:
            ax = _panel(fig, k, HEAD + tall[0] + GAP / 2, tall[1], morphed, across)
            draw_sets(ax, goals, box, camera)
            draw_skin(ax, skins[k].vertices[-1], skins[k], one.grid.fixed, camera)
            draw_goals(ax, goals, points[k], camera, 3.5)
    minutes = [np.nan if one.print_seconds is None else one.print_seconds / 60 for one in answers]
    by = f" ({answers[0].printer})" if answers[0].printer else ""
    left, right = _axes(fig)
    _chart(left, answers, [one.actuator_mm for one in answers], "length of the actuators, mm")
    _chart(right, answers, minutes, f"print, minutes{by}")
    left.set_ylabel("error, mm", fontsize=8)
    style.legend(fig)
    return style.ink(fig)


def _head(fig: Figure, k: int, one: Answer) -> None:
    """Write what an answer costs above its card."""
    width, height = fig.get_size_inches()
    by = "by the engine" if one.check.error_fea_mm is None else "by finite elements"
    beaten = "   (collides)" if one.collides else "" if one.on_front else "   (beaten)"
    many = "actuator" if one.actuators == 1 else "actuators"
    lines = [by, f"{one.actuators} {many}, {one.actuator_mm:.0f} mm"]
    if one.print_seconds is not None:
        share = "" if one.share is None else f", {100 * one.share:.0f} % within"
        lines.append(f"{one.print_seconds / 60:.0f} min to print{share}")
    for place, text in enumerate([f"{k + 1}   {one.error:.2f} mm{beaten}", *lines]):
        fig.text(
            (k * WIDE + 0.06) / width, 1 - (0.14 + 0.17 * place) / height, text, fontsize=7,
            va="center", fontweight="normal" if place else "bold",
        )  # fmt: skip


def _panel(fig: Figure, k: int, top: float, tall: float, corners: Corners, across: float) -> Axes:
    """Return axes for one picture of a card.

    Args:
        fig: the figure.
        k: which card.
        top: inches from the top of the figure.
        tall: height, inches.
        corners: of what is drawn, mm.
        across: width of what is drawn, mm.
    """
    width, height = fig.get_size_inches()
    ax = fig.add_axes(
        ((k + 0.04) * WIDE / width, 1 - (top + tall) / height, 0.92 * WIDE / width, tall / height)
    )
    low, high = corners
    middle = float(low[0] + high[0]) / 2
    ax.set_xlim(middle - across / 2, middle + across / 2)
    ax.set_ylim(low[1], high[1])
    ax.set_aspect("equal")
    ax.axis("off")
    return ax


def _axes(fig: Figure) -> tuple[Axes, Axes]:
    """Return the axes of the two charts."""
    width, height = fig.get_size_inches()
    each, low = width / 2, FOOT + 0.3
    left, right = (
        fig.add_axes(
            (
                (0.62 + side * (each - 0.1)) / width,
                low / height,
                (each - 0.9) / width,
                (CHART - 0.45) / height,
            )
        )
        for side in (0, 1)
    )
    return left, right


def _chart(ax: Axes, answers: Sequence[Answer], at: Sequence[float], label: str) -> None:
    """Draw the errors of answers against something else that they cost."""
    errors, costs = np.array([one.error for one in answers]), np.array(at, dtype=float)
    known = np.isfinite(costs)
    front = np.zeros(len(answers), dtype=bool)
    front[known] = non_dominated(np.column_stack([errors, costs])[known])
    line = np.flatnonzero(front)[np.argsort(costs[front])]
    ax.step(costs[line], errors[line], where="post", color=TARGET, lw=1.0, zorder=1)
    for marks, face in ((known & front, TARGET), (known & ~front, "white")):
        ax.plot(costs[marks], errors[marks], "o", ms=5, mfc=face, mec=TARGET, mew=1.0, zorder=2)
    for k in np.flatnonzero(known):
        ax.annotate(
            str(k + 1), (costs[k], errors[k]), (4, 3), textcoords="offset points", fontsize=7
        )
    ax.set_ylim(0, 1.2 * float(errors.max()) or 1.0)
    if known.any():
        middle, half = np.ptp(costs[known]) / 2 + costs[known].min(), 0.62 * np.ptp(costs[known])
        half = max(half, 0.01 * middle)  # what hardly differs does not look as if it did
        ax.set_xlim(middle - half, middle + half)
    ax.set_xlabel(label, fontsize=8)
    ax.grid(lw=0.3, color=style.GHOST_LINE)
    ax.spines[["top", "right"]].set_visible(False)
    ax.tick_params(labelsize=7)


def _union(extents: Sequence[Corners]) -> Corners:
    low, high = (np.array(ends) for ends in zip(*extents, strict=True))
    margin = MARGIN * float(np.max(high - low))
    return low.min(axis=0) - margin, high.max(axis=0) + margin
