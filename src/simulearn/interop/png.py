"""Pictures as small PNG files, to be kept inside of pages and notebooks."""

from io import BytesIO
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 110
COLOURS = 256


def png(figure: "Figure") -> tuple[bytes, int, int]:
    """Return a figure as a PNG with few colours, its width and its height in pixels.

    Args:
        figure: what is drawn.
    """
    from PIL import Image

    drawn, content = BytesIO(), BytesIO()
    figure.savefig(drawn, format="png", dpi=DPI)
    with Image.open(drawn) as image:
        few = image.convert("RGB").quantize(COLOURS, Image.Quantize.MAXCOVERAGE)
    few.save(content, "png", optimize=True)
    return content.getvalue(), *few.size
