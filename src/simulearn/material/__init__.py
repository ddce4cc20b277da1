"""Material systems as data."""

from simulearn.material.family import Family, Member, draw_member, member_of
from simulearn.material.material import (
    ElasticData,
    Identity,
    MarlowData,
    Material,
    Scatter,
    Section,
)
from simulearn.material.own import check_name, material_text, materials_of, own_material
from simulearn.material.reading import load_material, name_of, names, read_material

__all__ = [
    "ElasticData",
    "Family",
    "Identity",
    "MarlowData",
    "Material",
    "Member",
    "Scatter",
    "Section",
    "check_name",
    "draw_member",
    "load_material",
    "material_text",
    "materials_of",
    "member_of",
    "name_of",
    "names",
    "own_material",
    "read_material",
]
