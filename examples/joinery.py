"""A diagonal support for a mitred wood joint, by forward design (SimuLearn, UIST 2020, Figure 19).

Two panels meet at a right angle. A centrepiece lies across the corner and curls until its two ends
stand in slits of the panels. The designer draws, simulates and looks: which of five actuations
turns the ends square to the panels, where the slits must be, and whether the piece clears the wood.

    python examples/joinery.py [-o out/joinery] [--engine learned]
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from simulearn.grid import Grid, make, write_grid
from simulearn.show import combined
from simulearn.simulate import Result, engine, one, results

LENGTH = 55.0  # mm, of the beams
# Ratios of the beams that run across the corner: in the rim, in the middle.
VARIANTS = ((0.25, 0.25), (0.5, 0.5), (0.25, 0.75), (0.5, 0.75), (0.75, 0.75))
STIFFENING = 0.5  # of the rim beams along the corner, which keep the ends straight
ENDS = ((0, 3, 6), (2, 5, 8))  # joints that go into either panel


def design(rim: float, inner: float) -> Grid:
    """Return a centrepiece: beams across the corner curl up, those amid it a little down."""
    plain = make("flat", length=LENGTH)
    start, end = plain.joints[plain.beams.T]
    across = np.abs(end - start)[:, 0] > 1
    middle = ~across & (np.abs(start[:, 0]) < 1)
    curl = np.where(np.abs(start[:, 1]) > 1, rim, inner)
    ratios = np.where(across, curl, np.where(middle, -STIFFENING, 0.0))
    return Grid(plain.joints, plain.beams, ratios, plain.fixed)


@dataclass(frozen=True)
class Fit:
    """How a centrepiece sits in the corner.

    Attributes:
        turned: angle between its two ends, degrees; 90 makes both square to their panels.
        slits: distance of the ends from the corner's edge along either panel, mm.
        clearance: least distance of the piece from the edge, mm.
    """

    turned: float
    slits: tuple[float, float]
    clearance: float


def fit(result: Result) -> Fit:
    """Return how a piece sits between panels that its ends meet squarely."""
    joints = result.joints[-1]
    ups, centres = [], []
    for end in ENDS:
        corners = joints[list(end)]
        up = (corners[:, 4:] - corners[:, :4]).mean(axis=(0, 1))
        ups.append(up / np.linalg.norm(up))
        centres.append(corners.mean(axis=(0, 1)))
    turned = float(np.degrees(np.arccos(np.clip(ups[0] @ ups[1], -1, 1))))
    # Seen along the corner: the ends' tangents are square to their normals and lie in the panels'
    # normals, so a panel runs along its end's normal.
    flat = np.array([0, 2])
    a, b = centres[0][flat], centres[1][flat]
    u, v = ups[0][flat], ups[1][flat]
    lengths = np.linalg.solve(np.stack([u, -v], axis=1), b - a)
    edge = a + lengths[0] * u
    away = np.linalg.norm(result.beams[-1][..., flat].reshape(-1, 2) - edge, axis=1)
    return Fit(turned, (abs(float(lengths[0])), abs(float(lengths[1]))), float(away.min()))


def main(words: list[str] | None = None) -> Fit:
    """Simulate the variants at once, choose one, and check it by finite elements."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("out/joinery"))
    parser.add_argument("--engine", default="learned")
    options = parser.parse_args(words)
    options.output.mkdir(parents=True, exist_ok=True)
    grids = [design(*ratios) for ratios in VARIANTS]
    fits = [fit(result) for result in results(engine(options.engine).simulate(grids))]
    for (rim, inner), shape in zip(VARIANTS, fits, strict=True):
        print(f"rim {rim:g}, middle {inner:g}: ends turned by {shape.turned:.1f} degrees")
    best = min(range(len(fits)), key=lambda k: abs(fits[k].turned - 90))
    result = one(engine("fea").simulate([grids[best]])[0])
    shape = fit(result)
    print(
        f"rim and middle {VARIANTS[best]} by finite elements: {shape.turned:.1f} degrees; slits "
        f"{shape.slits[0]:.1f} and {shape.slits[1]:.1f} mm from the corner, "
        f"clearance {shape.clearance:.1f} mm"
    )
    write_grid(grids[best], options.output / "centrepiece.json")
    combined(result).savefig(options.output / "centrepiece.png")
    return shape


if __name__ == "__main__":
    main()
