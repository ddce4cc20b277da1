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
from simulearn.show.inverse import SPACING, TARGET, draw_goals
from simulearn.simulate import Result, skin

Array = NDArray[np.float64]
Corners = tuple[Array, Array]  # lower left and upper right, (2,) mm

LEAST, WIDE = 5, 1.75  # cards in a row whose width is left for charts; inches of a card
HEAD, CHART, FOOT = 0.78, 2.3, 0.45  # inches


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
    surfaces = [None if shape is None else skin(shape, SPACING) for shape in shapes]
    plans = _union([extent_flat(one.grid.centred) for one in answers])
    placed = camera.see(goals.targets)[:, :2]
    drawn = [extent_deformed(surface, camera, [-1]) for surface in surfaces if surface is not None]
    morphed = _union([*drawn, (placed.min(axis=0), placed.max(axis=0))])
    across = max(float(high[0] - low[0]) for low, high in (plans, morphed))
    tall = [WIDE * float(high[1] - low[1]) / across for low, high in (plans, morphed)]
    width = WIDE * max(LEAST, len(answers))
    height = HEAD + sum(tall) + 0.2 + CHART + FOOT
    fig = Figure(figsize=(width, height), dpi=style.DPI)
    for k, (one, shape, surface) in enumerate(zip(answers, shapes, surfaces, strict=True)):
        left = k * WIDE / width
        for line, (text, bold) in enumerate(_words(k, one)):
            y = 1 - (0.14 + 0.17 * line) / height
            weight = "bold" if bold else "normal"
            fig.text(left + 0.06 / width, y, text, fontsize=7, va="center", fontweight=weight)
        top = HEAD
        for corners, inches in zip((plans, morphed), tall, strict=True):
            ax = _panel(fig, (left, top, inches), corners, across)
            top += inches + 0.1
            if corners is plans:
                draw_flat(ax, one.grid.centred, False)
            elif shape is not None and surface is not None:
                draw_skin(ax, surface.vertices[-1], surface, one.grid.fixed, camera)
                points = goals.points(shape.joints[-1], shape.beams[-1])
                draw_goals(ax, goals, points, camera, 3.5)
    axes = [
        fig.add_axes(
            (
                (0.62 + side * (width / 2 - 0.1)) / width,
                (FOOT + 0.3) / height,
                (width / 2 - 0.9) / width,
                (CHART - 0.45) / height,
            )
        )
        for side in (0, 1)
    ]
    _chart(axes[0], answers, [one.actuator_mm for one in answers], "length of the actuators, mm")
    minutes = [np.nan if one.print_seconds is None else one.print_seconds / 60 for one in answers]
    _chart(axes[1], answers, minutes, f"print, minutes ({answers[0].printer or 'not known'})")
    axes[0].set_ylabel("error, mm", fontsize=8)
    style.legend(fig)
    return style.ink(fig)


def _words(k: int, one: Answer) -> list[tuple[str, bool]]:
    """Return the lines above a card, and whether they are bold."""
    by = "by the engine" if one.check.error_fea_mm is None else "by finite elements"
    lines = [
        (f"{k + 1}   {one.error:.2f} mm{'' if one.on_front else '   (beaten)'}", True),
        (by, False),
        (f"{one.actuators} actuators, {one.actuator_mm:.0f} mm", False),
    ]
    if one.print_seconds is not None:
        share = "" if one.share is None else f", {100 * one.share:.0f} % within"
        lines.append((f"{one.print_seconds / 60:.0f} min to print{share}", False))
    return lines


def _panel(fig: Figure, place: tuple[float, float, float], corners: Corners, across: float) -> Axes:
    """Return axes for one picture of a card.

    Args:
        fig: the figure.
        place: left end as a share of the figure's width; inches from its top; height in inches.
        corners: of what is drawn, mm.
        across: width of what is drawn, mm.
    """
    left, top, inches = place
    width, height = fig.get_size_inches()
    share = WIDE / width
    bottom = 1 - (top + inches) / height
    ax = fig.add_axes((left + 0.04 * share, bottom, 0.92 * share, inches / height))
    low, high = corners
    middle = float(low[0] + high[0]) / 2
    ax.set_xlim(middle - across / 2, middle + across / 2)
    ax.set_ylim(low[1], high[1])
    ax.set_aspect("equal")
    ax.axis("off")
    return ax


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
        offset = (0, 5)
        ax.annotate(
            str(k + 1), (costs[k], errors[k]), offset, textcoords="offset points",
            fontsize=7, ha="center",
        )  # fmt: skip
    ax.set_ylim(0, 1.2 * float(errors.max()) or 1.0)
    ax.margins(x=0.12)
    ax.set_xlabel(label, fontsize=8)
    ax.grid(lw=0.3, color=style.GHOST_LINE)
    ax.spines[["top", "right"]].set_visible(False)
    ax.tick_params(labelsize=7)


def _union(extents: Sequence[Corners]) -> Corners:
    low, high = zip(*extents, strict=True)
    return np.min(low, axis=0), np.max(high, axis=0)
