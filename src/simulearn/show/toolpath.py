"""A toolpath from above: one layer large, or all of them side by side, coloured by role.

Beads of one layer are drawn nearly as wide as they are printed; side by side, where there is no
room to tell them apart, wide enough to close. An active bead has the colour of its half, as in the
picture of the design; what is not actuated is grey, the darker the more it binds; the brim, which
is cut off, is light brown.
"""

from math import ceil
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.offsetbox import AnchoredOffsetbox, DrawingArea, HPacker, TextArea
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from simulearn.fabricate import Layer, Toolpath
from simulearn.fabricate.toolpath import ACTIVE, BRIM, JOINT, PASSIVE, SHELL, SKIRT
from simulearn.palette import BEADS
from simulearn.show import style

Array = NDArray[np.float64]
TRAVEL = "#009e73"  # of the same palette as the halves
COLUMNS = 4
PART, CLOSED = 0.82, 1.5  # of a bead's width: distinct, or closed to an area


def layers(path: Toolpath, title: str = "", width: float = 7.2) -> Figure:
    """Return the picture of all layers of a toolpath, side by side from the bed up.

    Args:
        path: what to draw.
        title: a line of words beneath.
        width: of the figure, inches.
    """
    low, high = _extent(path.layers, skirt=False)
    margin = 0.06 * float(max(high - low))
    low, high = low - margin, high + margin
    columns = min(COLUMNS, len(path.layers))
    rows = ceil(len(path.layers) / columns)
    side, words = width / columns, 0.17  # inches
    tall = side * float((high - low)[1] / (high - low)[0]) + words
    height = rows * tall + style.FOOT
    fig = Figure(figsize=(width, height), dpi=style.DPI)
    inch = float((high - low)[0] / side)
    for k, layer in enumerate(path.layers):
        row, column = divmod(k, columns)
        bottom = style.FOOT + (rows - 1 - row) * tall
        place = (
            column / columns,
            bottom / height,
            1 / columns,
            (tall - words) / height,
        )
        ax = _axes(fig, place, low, high)
        _beads(ax, layer, _top(path, k), CLOSED * 72 / inch, skirt=False)
        fig.text(
            place[0] + 0.5 / columns,
            (bottom + tall - 0.6 * words) / height,
            f"layer {k + 1}, z {layer.z:.2f} mm",
            ha="center",
            va="center_baseline",
            fontsize=6.5,
        )
    foot = _axes(fig, (0, 0, 1, style.FOOT / height), np.zeros(2), np.array([width, style.FOOT]))
    length = style.nice_length(float((high - low)[0]) * 2)
    _bar(foot, 0.06 * side, 0.4, length, 1 / inch)
    style.words(fig, title)
    roles = {bead.role for q in path.layers for bead in q.beads} - {SKIRT}
    _legend(fig, roles, (style.BOTTOM, style.TOP), travels=False)
    return style.ink(fig)


def layer(path: Toolpath, number: int, title: str = "", width: float = 5.2) -> Figure:
    """Return the picture of one layer, with its travels.

    Args:
        path: what to draw.
        number: of the layer, from 0.
        title: a line of words beneath.
        width: of the figure, inches.
    """
    shown = path.layers[number]
    low, high = _extent((shown,), skirt=True)
    fig = Figure(figsize=(width, width), dpi=style.DPI)
    ax, inch = style.footed(fig, low, high)
    _beads(ax, shown, _top(path, number), PART * 72 / inch, skirt=True)
    _travels(ax, shown)
    style.words(fig, title)
    colour = style.TOP if _top(path, number) else style.BOTTOM
    _legend(fig, {bead.role for bead in shown.beads}, (colour,), travels=True)
    return style.ink(fig)


def _top(path: Toolpath, number: int) -> bool:
    """Return whether a layer belongs to the top half."""
    return number >= len(path.layers) // 2


def _extent(shown: tuple[Layer, ...], skirt: bool) -> tuple[Array, Array]:
    points = np.concatenate([b.points for q in shown for b in q.beads if skirt or b.role != SKIRT])
    return points.min(axis=0), points.max(axis=0)


def _axes(fig: Figure, place: tuple[float, float, float, float], low: Array, high: Array) -> Axes:
    ax = fig.add_axes(place)
    ax.set_xlim(low[0], high[0])
    ax.set_ylim(low[1], high[1])
    ax.set_aspect("equal")
    ax.axis("off")
    return ax


def _beads(ax: Axes, shown: Layer, top: bool, points: float, skirt: bool) -> None:
    """Draw the beads of a layer; a mm of width is so many points."""
    colours = BEADS | {ACTIVE: style.TOP if top else style.BOTTOM}
    for role in (SKIRT, BRIM, PASSIVE, JOINT, ACTIVE, SHELL):
        colour = colours[role]
        beads = [b for b in shown.beads if b.role == role]
        if not beads or (role == SKIRT and not skirt):
            continue
        pieces = np.concatenate([np.stack([b.points[:-1], b.points[1:]], axis=1) for b in beads])
        widths = np.concatenate([b.widths for b in beads]) * points
        draw: Any = ax.add_collection
        kind: dict[str, Any] = {"colors": colour, "linewidths": widths, "capstyle": "round"}
        draw(LineCollection(list(pieces), **kind), autolim=False)


def _travels(ax: Axes, shown: Layer) -> None:
    """Draw the travels between beads."""
    travels = [
        (a.points[-1], b.points[0]) for a, b in zip(shown.beads, shown.beads[1:], strict=False)
    ]
    kind: dict[str, Any] = {"colors": TRAVEL, "linewidths": 0.6, "linestyles": (0, (3, 1.5))}
    draw: Any = ax.add_collection
    draw(LineCollection(travels, zorder=4, **kind), autolim=False)
    x, y = shown.beads[0].points[0]
    ax.plot([x], [y], "o", ms=3, color=TRAVEL, zorder=4)


def _bar(ax: Axes, x: float, y: float, length: float, scale: float) -> None:
    """Draw a scale bar for pictures of another scale (inches for each mm)."""
    ax.plot([x, x + length * scale], [y, y], color=style.INK, lw=1.6, solid_capstyle="butt")
    ax.annotate(
        f"{length:g} mm",
        (x + length * scale, y),
        xytext=(3, 0),
        textcoords="offset points",
        va="center_baseline",
        fontsize=7,
    )


def _legend(fig: Figure, roles: set[str], active: tuple[str, ...], travels: bool) -> None:
    """Draw the key to the roles that occur, a row of swatches in the middle of the bottom."""
    size = 7.0  # points
    entries: list[Artist] = []

    def entry(text: str, *colours: str) -> None:
        box = DrawingArea(size * len(colours), size)
        for k, colour in enumerate(colours):
            thick = 0.25 if colour == TRAVEL else 1.0
            box.add_artist(
                Rectangle(
                    (k * size, size * (1 - thick) / 2), size, thick * size, fc=colour, ec="none"
                )
            )
        words = TextArea(text, textprops={"fontsize": 6.5})
        entries.append(HPacker(children=[box, words], align="center", pad=0, sep=4))

    if SKIRT in roles:
        entry("skirt", BEADS[SKIRT])
    if BRIM in roles:
        entry("brim", BEADS[BRIM])
    if SHELL in roles:
        entry("shell", BEADS[SHELL])
    if ACTIVE in roles:
        halves = [("bottom half", "top half")[colour == style.TOP] for colour in active]
        entry(f"active ({', '.join(halves)})", *active)
    if PASSIVE in roles:
        entry("passive", BEADS[PASSIVE])
    if JOINT in roles:
        entry("joint", BEADS[JOINT])
    if travels:
        entry("travel, from the dot", TRAVEL)
    key = AnchoredOffsetbox(
        "lower center",
        child=HPacker(children=entries, align="center", pad=0, sep=12),
        bbox_to_anchor=(0.5, 0.1 / fig.get_size_inches()[1]),
        bbox_transform=fig.transFigure,
        frameon=False,
        pad=0,
        borderpad=0,
    )
    fig.add_artist(key)
