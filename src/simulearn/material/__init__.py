"""Material systems as data."""

from simulearn.material.family import Family, Member, draw_member, member_of
from simulearn.material.material import (
    ElasticData,
    Identity,
    MarlowData,
    Material,
    Scatter,
    Section,
    load_material,
    names,
    read_material,
)

__all__ = [
    "ElasticData",
    "Family",
    "Identity",
    "MarlowData",
    "Material",
    "Member",
    "Scatter",
    "Section",
    "draw_member",
    "load_material",
    "member_of",
    "names",
    "read_material",
]
