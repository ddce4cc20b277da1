"""Drawings of one design by other programs: a cell of 60 mm with a diagonal, drawn with slips."""

SIDE = 60.0  # mm
DIAGONAL = SIDE * 2**0.5

# Of the square one line ends .3 mm short of a corner and one runs .6 mm past another. One line
# dangles, one is a crumb. There are a text, a circle and a hidden layer, too.
SHAPES = """
<g inkscape:groupmode="layer" inkscape:label="frame" stroke="#888888" fill="none">
  <path d="M 0,0 H 59.7"/>
  <path d="M 60,0 V 60.6"/>
  <path d="M 60,60 H 0 V 0"/>
  <path d="M 0,60 v 40"/>
  <path d="M 20,20 h 0.2"/>
  <text x="5" y="5">front</text>
  <circle cx="30" cy="30" r="4"/>
</g>
<g inkscape:groupmode="layer" inkscape:label="top 0.5" stroke="#111111" fill="none">
  <path d="M 0,0 L 60,60"/>
</g>
<g inkscape:groupmode="layer" inkscape:label="old" style="display:none" stroke="#111111">
  <path d="M 0,60 L 60,0"/>
</g>
"""


def svg(size: str = 'width="60mm" height="100mm" viewBox="0 0 60 100"') -> bytes:
    """Return the drawing as an SVG of some size."""
    spaces = (
        'xmlns="http://www.w3.org/2000/svg" '
        'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
    )
    return f"<svg {spaces} {size}>{SHAPES}</svg>".encode()


def without_unit() -> bytes:
    """Return the drawing as an SVG that does not say how large it is."""
    return svg('viewBox="0 0 60 100"')
