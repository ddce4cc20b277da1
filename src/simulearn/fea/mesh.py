"""From a grid to its solid: structured 20-node bricks in joints and beams.

A joint is a quadrilateral block, a beam a row of slabs from one joint's side to another's; see
`layout` for where they are divided.
"""

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, ElementHexS2, MeshHex

from simulearn.errors import InputError
from simulearn.fea.layout import COARSE, Layout, breaks_of, net_lengths
from simulearn.fea.printing import printing
from simulearn.fea.sampling import sampling
from simulearn.fea.solid import Solid
from simulearn.grid import Grid, Outline, outline
from simulearn.material import Material, Section

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

GAUSS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3), np.array([0.5, 0.5])  # two points on [0, 1]


def mesh(
    grid: Grid, material: Material, layout: Layout = COARSE, factors: Array | None = None
) -> Solid:
    """Return the solid of a grid, its fixed joint at the origin.

    Args:
        grid: the design.
        material: its material system.
        layout: how finely it is meshed.
        factors: (B,) by which the released strains of beams differ from the material's.

    Raises:
        InputError: a joint has no outline.
    """
    grid = grid.centred
    section = material.section
    shape = outline(grid, section)
    along, across, up = breaks_of(grid, shape, section, layout)
    up = (up - 0.5) * section.thickness

    joints, beams = _number(grid, shape, layout.slabs, len(across), len(up))
    places = np.empty((max(joints.max(), beams.max()) + 1, 3))
    x, y = across[:, None, None], across[None, :, None]
    c = shape.joints[:, :, None, None, :]  # corner k, then places over the block
    places[joints, :2] = (
        (1 - x) * (1 - y) * c[:, 0]
        + x * (1 - y) * c[:, 1]
        + x * y * c[:, 2]
        + (1 - x) * y * c[:, 3]
    )[:, :, :, None, :]
    t = along[:, 1:-1, None, None]
    e = shape.beams[:, :, :, None, None, :]  # [start, end], [right, left]
    right = (1 - t) * e[:, 0, 0] + t * e[:, 1, 0]
    left = (1 - t) * e[:, 0, 1] + t * e[:, 1, 1]
    places[beams[:, 1:-1], :2] = ((1 - y) * right + y * left)[:, :, :, None, :]
    places[joints, 2] = places[beams, 2] = up

    in_joints, in_beams = _cells(joints), _cells(beams)
    # Where a brick lies: (beam, slab, across, layer) or (-1, joint, across, layer).
    where = np.concatenate([in_joints[1], in_beams[1]])
    where[: len(in_joints[1]), 1] = where[: len(in_joints[1]), 0]
    where[: len(in_joints[1]), 0] = -1

    (points, weights), (joint_points, joint_weights) = _rules(section, layout)
    basis = Basis(
        MeshHex(
            np.ascontiguousarray(places.T),
            np.ascontiguousarray(np.concatenate([in_joints[0], in_beams[0]]).T),
        ),
        ElementHexS2(),
        quadrature=(points, weights),
    )
    bricks = np.asarray(basis.element_dofs.T, dtype=np.int64)
    if not (np.asarray(basis.dx) > 0).all():
        raise InputError(
            "the outlines of the grid fold over: its joints are too close or too acute"
        )
    beam, slab, strip, layer = where.T
    middle = ((up[1:] + up[:-1]) / 2 / section.thickness)[layer]
    support = grid.support
    held = (beam == -1) & (slab == support.joint)
    held &= (support.lower <= middle) & (middle <= support.upper)
    centre = (along[:, 1:] + along[:, :-1]) / 2  # of slabs
    width = np.diff(across)
    rule = np.where(beam[:, None] < 0, joint_points[2], points[2])
    heights = up[layer][:, None] + np.diff(up)[layer][:, None] * rule
    angle, growth, stress = printing(
        grid,
        material,
        beam=beam,
        along=np.where(beam < 0, 0.5, centre[beam, slab % layout.slabs]),
        across=across[strip][:, None] + width[strip][:, None] * points[1],
        up=heights / section.thickness,
        top=layer >= layout.layers,
        factors=factors,
    )
    # Scikit-fem numbers the vertices first, so that a vertex is its own node.
    corner = joints[:, [0, -1, -1, 0], [0, 0, -1, -1]]  # (J, 4, up)
    section_ = beams[:, [0, layout.slabs // 2, -1]][:, :, [0, -1]]  # (B, 3, [right, left], up)
    samples, shares = sampling(
        along,
        net_lengths(shape),
        across,
        layout.layers,
        points,
        section,
    )
    return Solid(
        nodes=np.ascontiguousarray(basis.doflocs.T),
        bricks=bricks,
        parts=where[:, :2],
        slabs=layout.slabs,
        points=points,
        weights=weights,
        joint_points=joint_points,
        joint_weights=joint_weights,
        angle=angle,
        growth=growth,
        stress=stress,
        fixed=np.unique(bricks[held]),
        joints=corner[:, :, [0, -1]].swapaxes(1, 2).reshape(-1, 8),
        beams=section_[..., [0, -1]].swapaxes(2, 3).reshape(-1, 3, 4),
        samples=samples,
        shares=shares,
    )


def _number(
    grid: Grid, shape: Outline, slabs: int, wide: int, high: int
) -> tuple[Indices, Indices]:
    """Number the vertices of joints (J, wide, wide, high) and beams (B, slabs + 1, wide, high).

    Beams begin and end with the vertices of the joint sides that they meet.
    """
    joints = np.arange(len(grid.joints) * wide * wide * high).reshape(-1, wide, wide, high)
    # Side k of a joint from its corner k to k + 1, which is right to left looking outwards.
    sides = np.stack(
        [joints[:, :, 0], joints[:, -1, :], joints[:, ::-1, -1], joints[:, 0, ::-1]], axis=1
    )
    start, end = sides[grid.beams.T, shape.sides.T]
    inner = np.arange(len(grid.beams) * (slabs - 1) * wide * high).reshape(
        -1, slabs - 1, wide, high
    )
    return joints, np.concatenate([start[:, None], joints.size + inner, end[:, None, ::-1]], axis=1)


def _cells(vertices: Indices) -> tuple[Indices, Indices]:
    """Return the bricks (E, 8) between vertices (M, ., ., .), and (E, 4) where each one lies."""
    m, a, b, c = np.array(vertices.shape) - [0, 1, 1, 1]
    where = np.moveaxis(np.indices((m, a, b, c)), 0, -1).reshape(-1, 4)
    corners = MeshHex.elem.refdom.p.T.astype(int)
    k, x, y, z = (where[:, None, :] + np.pad(corners, ((0, 0), (1, 0)))).transpose(2, 0, 1)
    return vertices[k, x, y, z], where


def _rules(section: Section, layout: Layout) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Return the rules of beams and joints: points (3, Q) of a brick, weights (Q,) adding to one.

    Bricks that share a section have two Gauss points each way, the reduced rule of a 20-node
    brick. One that spans it all has four across, one amid each shell and two in the core, set so
    that the rule is still exact to third degree. Alone in a joint, the reduced rule would leave
    soft modes, and four points one way would tell x from y: there it is the eight points of fifth
    degree in the plane (Stroud 1971, C2: 5-2), which a quarter turn does not change.
    """
    if layout.core:
        reduced = _product(GAUSS, GAUSS, GAUSS)
        return reduced, reduced
    shell = section.shell / section.width or 1 / 8
    outer = (1 - shell) / 2
    inner = np.sqrt((1 / 12 - 2 * shell * outer**2) / (1 - 2 * shell))
    if not inner < 0.5 - shell:
        raise InputError(
            f"shells of {section.shell} mm are too wide for one brick across "
            f"{section.width} mm; use a layout with core = 1"
        )
    across = (
        0.5 + np.array([-outer, -inner, inner, outer]),
        np.array([shell, 0.5 - shell, 0.5 - shell, shell]),
    )
    a, b = np.sqrt([7 / 15, 7 / 9]) / 2
    plane = np.array([[a, 0], [0, a], [-a, 0], [0, -a], [b, b], [-b, b], [-b, -b], [b, -b]])
    share = np.repeat([10 / 49, 9 / 196], 4)
    joint = (
        np.concatenate([np.tile(0.5 + plane.T, 2), [np.repeat(GAUSS[0], 8)]]),
        np.tile(share, 2) / 2,
    )
    return _product(GAUSS, across, GAUSS), joint


def _product(*axes: tuple[Array, Array]) -> tuple[Array, Array]:
    """Return the points (3, Q) and weights (Q,) of the product of three rules."""
    points = np.stack(np.meshgrid(*(p for p, _ in axes), indexing="ij")).reshape(3, -1)
    weights = np.prod(np.meshgrid(*(w for _, w in axes), indexing="ij"), axis=0).reshape(-1)
    return points, weights
