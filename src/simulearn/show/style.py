"""The style of pictures: colours, line weights, legend, scale bar.

Top and bottom actuators have the colours of the palette; a longer one has a deeper tint of them.
"""

from collections.abc import Sequence
from textwrap import shorten

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.offsetbox import AnchoredOffsetbox, DrawingArea, HPacker, TextArea
from matplotlib.patches import Rectangle
from matplotlib.text import Text
from matplotlib.typing import ColorType
from numpy.typing import ArrayLike, NDArray

from simulearn.palette import BOTTOM, TOP

PASSIVE, JOINT, FIXED = "#dcdcdc", "#a6a6a6", "#3a3a3a"
SOLID = "#e3d6c1"  # of an obstacle
GHOST, GHOST_LINE = "#f0f0f0", "#cfcfcf"
COLLISION = "#c8102e"  # the ring where parts run through each other
INK, LINE = "#262626", "#4d4d4d"
PALEST = 0.42  # of the full hue, the tint of a very short actuator
PLAIN = ("black", "k", "#000000")  # the colours of a text that nobody coloured
DPI = 200
LETTERS = 20  # of a remark in an inch


def ink(fig: Figure) -> Figure:
    """Give texts and lines of a finished figure the ink of a paper, and return the figure.

    Matplotlib's settings belong to the whole process, so they are left alone: a figure is styled
    when it is finished, and sizes stand where texts are written.
    """
    for text in fig.findobj(Text):
        if text.get_color() in PLAIN:
            text.set_color(INK)
    for line in fig.findobj(Line2D):
        if line.get_solid_capstyle() == "projecting":
            line.set_solid_capstyle("round")
    return fig


def tint(ratio: ArrayLike) -> NDArray[np.float64]:
    """Return the colours of actuators of the given signed ratios: (..., 3), 0 being passive."""
    ratio = np.asarray(ratio, dtype=float)[..., None]
    hue = np.where(ratio > 0, to_rgb(TOP), to_rgb(BOTTOM))
    depth = PALEST + (1 - PALEST) * np.abs(ratio)
    return np.where(ratio == 0, to_rgb(PASSIVE), 1 - depth * (1 - hue))


def colours(
    ratio: NDArray[np.float64], joint: NDArray[np.int64], fixed: int
) -> NDArray[np.float64]:
    """Return the colours (Q, 3) of a skin's quadrilaterals."""
    rgb = tint(ratio)
    rgb[joint >= 0] = to_rgb(JOINT)
    rgb[joint == fixed] = to_rgb(FIXED)
    return rgb


FOOT = 0.56  # inches at the bottom of a picture for scale bar, words and legend


def footed(fig: Figure, low: NDArray[np.float64], high: NDArray[np.float64]) -> tuple[Axes, float]:
    """Give a figure of a fixed width the height that a picture from low to high (2,) needs.

    Returns:
        The axes for the picture, and how many mm of it an inch is.
    """
    width = fig.get_size_inches()[0]
    margin = 0.05 * float(max(high - low))
    across, up = high - low + 2 * margin
    height = width * up / across + FOOT
    fig.set_size_inches(width, height)
    ax = fig.add_axes((0, FOOT / height, 1, 1 - FOOT / height))
    ax.set_xlim(low[0] - margin, high[0] + margin)
    ax.set_ylim(low[1] - margin, high[1] + margin)
    ax.set_aspect("equal")
    ax.axis("off")
    inch = float(across / width)
    length = nice_length(float(across))
    scale_bar(ax, low[0], low[1] - margin - (FOOT - 0.4) * inch, length)
    return ax, inch


def nice_length(span: float) -> float:
    """Return a round length (1, 2 or 5 times a power of ten) of about a quarter of the span."""
    decade = 10.0 ** np.floor(np.log10(span / 4))
    return float(max(step * decade for step in (1, 2, 5) if step * decade <= span / 4))


def scale_bar(ax: Axes, x: float, y: float, length: float) -> None:
    """Draw a bar of the given length (mm) from (x, y) to the right, its length written after it."""
    ax.plot([x, x + length], [y, y], color=INK, lw=1.6, solid_capstyle="butt", clip_on=False)
    ax.annotate(
        f"{length:g} mm",
        (x + length, y),
        xytext=(3, 0),
        textcoords="offset points",
        va="center_baseline",
        fontsize=7,
        annotation_clip=False,
    )


def words(fig: Figure, text: str) -> Text:
    """Write a line of text above the legend, to the right."""
    width, height = fig.get_size_inches()
    right = 1 - 0.25 / width
    return fig.text(right, 0.4 / height, text, ha="right", va="center_baseline", fontsize=7)


def remark(fig: Figure, lines: Sequence[str]) -> None:
    """Write what qualifies an answer in a line above the legend, if there is anything."""
    if lines:
        width, height = fig.get_size_inches()
        text = shorten("; ".join(lines), int(LETTERS * width), placeholder=" ...")
        place = (1 - 0.25 / width, 0.27 / height)
        fig.text(*place, text, ha="right", va="center_baseline", fontsize=6, color=TOP)


def legend(fig: Figure, inches: float = 0.1) -> None:
    """Draw the key to the colours, a row of swatches in the middle, so high above the bottom."""
    size = 7.0  # points
    rows: list[Artist] = []

    def entry(text: str, colours: Sequence[ColorType]) -> None:
        box = DrawingArea(size * len(colours), size)
        for k, colour in enumerate(colours):
            box.add_artist(Rectangle((k * size, 0), size, size, fc=colour, ec=LINE, lw=0.4))
        words = TextArea(text, textprops={"fontsize": 6.5})
        rows.append(HPacker(children=[box, words], align="center", pad=0, sep=4))

    for half, sign in (("top", 1), ("bottom", -1)):
        tints = [tuple(tint(sign * ratio)) for ratio in (0.25, 0.5, 0.75, 1.0)]
        entry(f"{half} half active, ¼ to 1", tints)
    for name, colour in (("passive", PASSIVE), ("joint", JOINT), ("fixed", FIXED)):
        entry(name, [colour])
    key = AnchoredOffsetbox(
        "lower center",
        child=HPacker(children=rows, align="center", pad=0, sep=9),
        bbox_to_anchor=(0.5, inches / fig.get_size_inches()[1]),
        bbox_transform=fig.transFigure,
        frameon=False,
        pad=0,
        borderpad=0,
    )
    fig.add_artist(key)
