"""How pictures look: colours, line weights, legend, scale bar.

Top and bottom actuators have the vermillion and blue of Okabe and Ito's palette, which people with
any common colour blindness tell apart; a longer actuator has a deeper tint of them.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import ArrayLike, NDArray

TOP, BOTTOM = "#d55e00", "#0072b2"
PASSIVE, JOINT, FIXED = "#dcdcdc", "#a6a6a6", "#3a3a3a"
GHOST, GHOST_LINE = "#f0f0f0", "#cfcfcf"
INK, LINE = "#262626", "#4d4d4d"
PALEST = 0.42  # of the full hue, the tint of a very short actuator
DPI = 200


@contextmanager
def paper() -> Iterator[None]:
    """Text and lines as a paper has them."""
    with matplotlib.rc_context(
        {
            "font.size": 8,
            "text.color": INK,
            "svg.fonttype": "none",
            "pdf.fonttype": 42,
            "lines.solid_capstyle": "round",
        }
    ):
        yield


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


def bare(ax: Axes, low: NDArray[np.float64], high: NDArray[np.float64], margin: float) -> None:
    """Make an axes show nothing but what is drawn, mm on both axes, from low to high (2,)."""
    ax.set_xlim(low[0] - margin, high[0] + margin)
    ax.set_ylim(low[1] - margin, high[1] + margin)
    ax.set_aspect("equal")
    ax.axis("off")


def nice_length(span: float) -> float:
    """Return a round length (1, 2 or 5 times a power of ten) of about a quarter of the span."""
    decade = 10.0 ** np.floor(np.log10(span / 4))
    return float(max(step * decade for step in (1, 2, 5) if step * decade <= span / 4))


def scale_bar(ax: Axes, x: float, y: float, length: float) -> None:
    """Draw a bar of the given length (mm) from (x, y) to the right, its length written above."""
    ax.plot([x, x + length], [y, y], color=INK, lw=1.6, solid_capstyle="butt", clip_on=False)
    ax.annotate(
        f"{length:g} mm",
        (x + length / 2, y),
        xytext=(0, 3),
        textcoords="offset points",
        ha="center",
        va="bottom",
        annotation_clip=False,
    )


def legend(fig: Figure, left: float, bottom: float) -> None:
    """Draw the key to the colours, a row of swatches, from (left, bottom) in inches."""
    size, gap, x = 0.11, 0.05, left
    width, height = fig.get_size_inches()
    ax = fig.add_axes((0, 0, 1, 1), zorder=5)
    ax.set_xlim(0, width)
    ax.set_ylim(0, height)
    ax.axis("off")

    def swatch(at: float, colour: object) -> None:
        ax.add_patch(Rectangle((at, bottom), size, size, fc=colour, ec=LINE, lw=0.4))

    def words(at: float, text: str) -> float:
        ax.text(at, bottom + size / 2, text, va="center_baseline", fontsize=7)
        return at + 0.058 * len(text)

    for name, sign in (("top half", 1), ("bottom half", -1)):
        for ratio in (0.25, 0.5, 0.75, 1.0):
            swatch(x, tint(sign * ratio))
            x += size
        x = words(x + gap, f"{name}, ¼ to 1") + 0.14
    for name, colour in (("passive", PASSIVE), ("joint", JOINT), ("fixed", FIXED)):
        swatch(x, colour)
        x = words(x + size + gap, name) + 0.14


LEGEND_WIDTH = 5.0  # inches
