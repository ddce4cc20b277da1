"""Constitutive laws, each an energy density with its stress and moduli."""

from simulearn.fea.laws.law import Law
from simulearn.fea.laws.marlow import Marlow
from simulearn.fea.laws.neo_hookean import NeoHookean
from simulearn.fea.laws.st_venant_kirchhoff import StVenantKirchhoff
from simulearn.material import ElasticData, MarlowData

__all__ = ["Law", "Marlow", "NeoHookean", "StVenantKirchhoff", "law_of"]


def law_of(data: MarlowData | ElasticData) -> Law:
    """Return the law that a material system's data describe."""
    if isinstance(data, MarlowData):
        return Marlow.fit(data)
    shear = data.modulus / (2 * (1 + data.poisson))
    bulk = data.modulus / (3 * (1 - 2 * data.poisson))
    if data.kind == "neo-hookean":
        return NeoHookean(shear, bulk)
    return StVenantKirchhoff(bulk - 2 / 3 * shear, shear)
