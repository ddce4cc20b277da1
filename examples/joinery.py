"""A diagonal support for a mitred wood joint, by forward design (SimuLearn, UIST 2020, Figure 19).

Two panels meet at a right angle. A centrepiece lies across the corner and curls until its two ends
stand in slits of the panels. The designer draws, simulates and looks: which of five actuations
turns the ends square to the panels, where the slits must be, and whether the piece clears the wood.
Then two narrow side pieces slide in beside it and curl, too. All three are put together in this
order, with the panels as obstacles: how wide must the slits be, so that nothing hits the wood on
its way?

    python examples/joinery.py [-o out/joinery] [--engine learned]
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh

from simulearn.assembly import (
    Assembled,
    Assembly,
    Obstacle,
    Part,
    Step,
    simulate_assembly,
    write_assembly,
)
from simulearn.grid import Grid, make, write_grid
from simulearn.outputs import write_assembled
from simulearn.rigid import Place
from simulearn.show import Camera, combined
from simulearn.simulate import Result, engine, results

LENGTH = 55.0  # mm, of the beams
# Ratios of the beams that run across the corner: in the rim, in the middle.
VARIANTS = ((0.25, 0.25), (0.5, 0.5), (0.25, 0.75), (0.5, 0.75), (0.75, 0.75))
STIFFENING = 0.5  # of the rim beams along the corner, which keep the ends straight
SIDES = (0.5, 0.55, 0.6)  # ratios of a side piece
NARROW, GAP = 30.0, 16.0  # mm: width of a side piece between joints, its distance from the centre
SLIDE = 130.0  # mm, from where the side pieces come, along the corner
WOOD, STAND = 12.0, 0.5  # mm: thickness of the panels; how far their faces are before the joints
PANEL = (125.0, 280.0)  # mm
PLAY = 1.5  # mm, around all that goes through a slit
WRITTEN = (".png", ".strip.png", ".gif", ".glb")
CAMERA = Camera(azimuth=-68.0, elevation=-22.0)


def design(rim: float, inner: float) -> Grid:
    """Return a centrepiece: beams across the corner curl up, those amid it a little down."""
    plain = make("flat", length=LENGTH)
    start, end = plain.joints[plain.beams.T]
    across = np.abs(end - start)[:, 0] > 1
    middle = ~across & (np.abs(start[:, 0]) < 1)
    curl = np.where(np.abs(start[:, 1]) > 1, rim, inner)
    ratios = np.where(across, curl, np.where(middle, -STIFFENING, 0.0))
    return Grid(plain.joints, plain.beams, ratios, plain.fixed)


def side(curl: float) -> Grid:
    """Return a side piece: narrow, both its long beams curl up."""
    plain = make("flat", (2, 1), LENGTH)
    start, end = plain.joints[plain.beams.T]
    across = np.abs(end - start)[:, 0] > 1
    joints = plain.joints * [1, NARROW / LENGTH]
    return Grid(joints, plain.beams, np.where(across, curl, 0.0), plain.fixed)


@dataclass(frozen=True)
class Fit:
    """How a piece sits in the corner.

    Attributes:
        turned: angle between its two ends, degrees; 90 makes both square to their panels.
        slits: distance of the ends from the corner's edge along either panel, mm.
        clearance: least distance of the piece from the edge, mm.
        edge: (x, z) of the corner's edge, mm.
    """

    turned: float
    slits: tuple[float, float]
    clearance: float
    edge: tuple[float, float]


def fit(result: Result) -> Fit:
    """Return how a piece sits between panels that its ends meet squarely."""
    joints, x = result.joints[-1], result.grid.joints[:, 0]
    ups, centres = [], []
    for end in (x < x.min() + 1, x > x.max() - 1):
        corners = joints[end]
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
    slits = abs(float(lengths[0])), abs(float(lengths[1]))
    return Fit(turned, slits, float(away.min()), (float(edge[0]), float(edge[1])))


def put_together(centre: Result, narrow: Result) -> tuple[tuple[Part, ...], dict[str, Place]]:
    """Return the three pieces in their places, and the places of the two panels.

    A panel's own x goes from the corner's edge down along it, z through it to the outside.
    """
    edge = np.array(fit(centre).edge)
    away = edge - fit(narrow).edge
    y = narrow.centres[-1, :, 1]
    reach = float(centre.grid.joints[:, 1].max()) + GAP
    near, far = (Place(shift=np.array([away[0], at, away[1]])) for at in (reach, -reach))
    # Beside the centrepiece, the same grid on either side: turned about the vertical on one.
    parts = (
        Part("centre", centre.grid),
        Part("back", narrow.grid, near.after(Place(shift=np.array([0, -y.min(), 0])))),
        Part("front", narrow.grid, far.after(Place.about_z(180)).after(
            Place(shift=np.array([0, -y.min(), 0]))), copy_of="back"),
    )  # fmt: skip
    half = np.sqrt(0.5)
    at = np.array([edge[0], 0, edge[1]])
    right = np.array([[half, 0, half], [0, 1, 0], [-half, 0, half]])
    left = np.array([[-half, 0, -half], [0, -1, 0], [-half, 0, half]])
    return parts, {"left": Place(left, at), "right": Place(right, at)}


def slits(
    results: list[tuple[Result, Place]], panel: Place, frames: slice
) -> list[tuple[float, float, float, float]]:
    """Return the slits (x, x, y, y), whole mm, that a panel needs for the pieces in some frames."""
    found = []
    for result, place in results:
        corners = [result.joints[frames].reshape(-1, 3), result.beams[frames].reshape(-1, 3)]
        x, y, z = panel.back(place(np.concatenate(corners))).T
        inside = z > -STAND - PLAY
        ends = [side for v in (x[inside], y[inside]) for side in (v.min() - PLAY, v.max() + PLAY)]
        a, b, c, d = (float(f(v)) for f, v in zip((np.floor, np.ceil) * 2, ends, strict=True))
        found.append((a, b, c, d))
    return found


def panel_with(slits: list[tuple[float, float, float, float]]) -> trimesh.Trimesh:
    """Return a panel with slits through it, mitred at the corner."""
    x = np.unique([0, PANEL[0], *(v for slit in slits for v in slit[:2])])
    y = np.unique([-PANEL[1] / 2, PANEL[1] / 2, *(v for slit in slits for v in slit[2:])])
    middle = (x[1:, None] + x[:-1, None]) / 2, (y[1:] + y[:-1]) / 2
    wood = np.ones((len(x) + 1, len(y) + 1), bool)
    wood[[0, -1]] = wood[:, [0, -1]] = False
    for a, b, c, d in slits:
        wood[1:-1, 1:-1] &= ~((middle[0] > a) & (middle[0] < b) & (middle[1] > c) & (middle[1] < d))

    def corner(i: int, j: int, top: bool) -> list[float]:
        z = WOOD - STAND if top else -STAND
        return [x[i] - z if i == 0 else x[i], y[j], z]

    quads = []
    for i, j in np.argwhere(wood) - 1:
        ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        quads.append([corner(*p, True) for p in ring])
        quads.append([corner(*p, False) for p in ring[::-1]])
        for k, (di, dj) in enumerate([(0, -1), (1, 0), (0, 1), (-1, 0)]):
            if not wood[i + 1 + di, j + 1 + dj]:
                p, q = ring[k], ring[(k + 1) % 4]
                quads.append([corner(*p, False), corner(*q, False), corner(*q, True),
                              corner(*p, True)])  # fmt: skip
    points = np.reshape(quads, (-1, 3))
    faces = 4 * np.arange(len(quads))[:, None, None] + [[0, 1, 2], [0, 2, 3]]
    return trimesh.Trimesh(points, faces.reshape(-1, 3))


def in_order(parts: tuple[Part, ...], obstacles: list[Obstacle]) -> Assembly:
    """Return the assembly in its order, the centrepiece first."""
    offsets = {"back": (0.0, SLIDE, 0.0), "front": (0.0, -SLIDE, 0.0)}
    steps = (
        Step(("centre",), 1.5, name="the centrepiece curls"),
        Step(("back", "front"), 1.5, offsets, name="the sides slide in and curl"),
    )
    return Assembly(parts, steps, tuple(obstacles), name="joinery")


def assemble(
    centre: Result, narrow: Result, name: str, folder: Path, frames: slice = slice(None)
) -> Assembled:
    """Cut slits for what the pieces need in some frames, and check the assembly."""
    parts, panels = put_together(centre, narrow)
    placed = [(centre if part.name == "centre" else narrow, part.place) for part in parts]
    obstacles = []
    for key, place in panels.items():
        file = folder / f"{name}-{key}.stl"
        panel_with(slits(placed, place, frames)).export(file)
        obstacles.append(Obstacle(f"{key} panel", file, place))
    made = in_order(parts, obstacles)
    write_assembly(made, folder / f"{name}.json")
    assembled = simulate_assembly(made, engine(centre.engine))
    found = assembled.collisions
    worst = f", the deepest {found[0].words}" if found else ""
    print(f"{name}, by {assembled.engine}: {len(found)} collisions{worst}")
    return assembled


def main(words: list[str] | None = None) -> tuple[Fit, Assembled]:
    """Simulate the variants at once, choose one, and check it by finite elements."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("out/joinery"))
    parser.add_argument("--engine", default="learned")
    options = parser.parse_args(words)
    options.output.mkdir(parents=True, exist_ok=True)
    answering = engine(options.engine)
    grids = [design(*ratios) for ratios in VARIANTS]
    found = results(answering.simulate(grids))
    for (rim, inner), result in zip(VARIANTS, found, strict=True):
        print(f"rim {rim:g}, middle {inner:g}: ends turned by {fit(result).turned:.1f} degrees")
    best = min(range(len(found)), key=lambda k: abs(fit(found[k]).turned - 90))
    narrow = min(
        results(answering.simulate([side(curl) for curl in SIDES])),
        key=lambda result: abs(fit(result).turned - fit(found[best]).turned),
    )
    # With slits only for where the ends stand in the end, they hit the wood on their way there.
    assemble(found[best], narrow, "tight", options.output, slice(-1, None))
    checked = results(engine("fea").simulate([grids[best], narrow.grid]))
    shape = fit(checked[0])
    print(
        f"rim and middle {VARIANTS[best]} by finite elements: {shape.turned:.1f} degrees; slits "
        f"{shape.slits[0]:.1f} and {shape.slits[1]:.1f} mm from the corner, "
        f"clearance {shape.clearance:.1f} mm"
    )
    assembled = assemble(*checked, "joinery", options.output)
    for ending in WRITTEN:
        write_assembled(assembled, options.output / f"joinery{ending}", CAMERA)
    write_grid(grids[best], options.output / "centrepiece.json")
    write_grid(narrow.grid, options.output / "side.json")
    combined(checked[0]).savefig(options.output / "centrepiece.png")
    return shape, assembled


if __name__ == "__main__":
    main()
