"""Material systems as data."""

from simulearn.material.material import (
    ElasticData,
    MarlowData,
    Material,
    Section,
    load_material,
    names,
)

__all__ = ["ElasticData", "MarlowData", "Material", "Section", "load_material", "names"]
