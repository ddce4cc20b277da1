"""What designs are printed of, as the kernels take it: sections of beams, and what networks see."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.learn.common.model import Designs
from simulearn.mechanics.model import SectionLaw, section_of
from simulearn.mechanics.path import coefficients
from simulearn.mechanics.properties import Properties, properties_of, signs_of, stacked

Numbers = NDArray[np.float64]
# Properties, coefficients and signs of materials by their digest and the mesh.
Known = dict[tuple[str, float], tuple[Properties, Numbers, NDArray[np.float32]]]

REMEMBERED = 64  # materials


class Print(NamedTuple):
    """What a design is printed of, as the kernels take it.

    Attributes:
        properties: numbers of the material.
        section: (B + 1, coefficients) of the beams, and of joints.
        strain: (B,) released strain of the beams' active halves over that of the reference.
        signs: what networks see of the material; see `mechanics.properties.signs_of`.
    """

    properties: Properties
    section: Numbers
    strain: Numbers
    signs: NDArray[np.float32]


def prints_of(
    law: SectionLaw,
    designs: Designs,
    mesh: float,
    known: Known | None = None,
) -> list[Print]:
    """Return what each of the designs is printed of.

    Args:
        law: of sections.
        designs: T of them.
        mesh: 0 for answers as of the default mesh, 1 for those of the fine one.
        known: materials met lately, by digest and mesh; where all designs are of one, it is looked
            up here and added.
    """
    if known is not None and designs.factors is None and not designs.materials:
        key = designs.material.digest, mesh
        if key not in known:
            if len(known) >= REMEMBERED:
                known.clear()
            p = properties_of(designs.material, mesh)
            column = coefficients(section_of(law, p))
            known[key] = p, column, np.asarray(signs_of(p, np), np.float32)
        p, column, own = known[key]
        beams = len(designs.beams)
        section = np.ascontiguousarray(np.broadcast_to(column, (beams + 1, len(column))))
        return [Print(p, section, np.full(beams, p.strain), own)] * len(designs)
    materials = designs.materials or (designs.material,)
    each = [properties_of(material, mesh) for material in materials]
    beams, count = len(designs.beams), len(designs)
    many = stacked(each)
    if designs.factors is None:
        columns = coefficients(section_of(law, many)).T
        sections = [np.broadcast_to(row, (beams + 1, len(row))) for row in columns]
    else:  # joints as the material says
        factors = np.concatenate([designs.factors, np.ones((count, 1))], axis=1)
        if len(each) < count:
            each = each * count
            many = stacked(each)
        spread = Properties(*(np.repeat(x, beams + 1) for x in many))
        spread = spread._replace(strain=spread.strain * factors.ravel())
        sections = list(coefficients(section_of(law, spread)).T.reshape(count, beams + 1, -1))
    factors = np.ones((len(each), beams)) if designs.factors is None else designs.factors
    signs = np.asarray(signs_of(many, np).T, np.float32)
    prints = [
        Print(p, np.ascontiguousarray(section), p.strain * factor, np.ascontiguousarray(sign))
        for p, section, factor, sign in zip(each, sections, factors, signs, strict=True)
    ]
    return prints if len(prints) == count else prints * count
