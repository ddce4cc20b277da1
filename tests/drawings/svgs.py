"""SVG files written by hand, and what is read of them."""

from simulearn.drawings.svg import read_svg

NAMESPACES = (
    'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
)
PAGE = 'width="100mm" height="100mm" viewBox="0 0 100 100"'
PX = 'width="368.5px" height="368.5px" viewBox="0 0 368.5 368.5"'
ILLUSTRATOR = "<!-- Generator: Adobe Illustrator 26.0, SVG Export Plug-In . SVG Version: 6.00 -->"
LINE = '<line x1="10" y1="20" x2="60" y2="20"/>'


def svg(body, attributes=PAGE, before="", style='fill="none" stroke="black"'):
    return f"{before}<svg {NAMESPACES} {attributes}><g {style}>{body}</g></svg>"


def read(text):
    return read_svg(text.encode() if isinstance(text, str) else text)


def ends(drawing, digits=3):
    """First and last point of each line, mm where the unit is known."""
    mm = drawing.unit.mm if drawing.unit else 1.0
    return [
        tuple(map(float, (mm * line.points[[0, -1], :2]).ravel().round(digits) + 0.0))
        for line in drawing.lines
    ]


def drawn(body, **options):
    return ends(read(svg(body, **options)))


def left(drawing):
    """Counts of what is left out, by kind, layer and reason."""
    return {(x.kind, x.layer, x.reason): x.count for x in drawing.left_out}
