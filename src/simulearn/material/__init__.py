"""Material systems as data."""

from simulearn.material.material import (
    ElasticData,
    Identity,
    MarlowData,
    Material,
    Section,
    load_material,
    names,
    read_material,
)

__all__ = [
    "ElasticData",
    "Identity",
    "MarlowData",
    "Material",
    "Section",
    "load_material",
    "names",
    "read_material",
]
