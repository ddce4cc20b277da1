"""The material of a grid that is drawn in a model: a name, or the text of a file."""

from collections.abc import Mapping
from dataclasses import replace

from simulearn.errors import InputError
from simulearn.grid import Grid
from simulearn.material import Material, names, own_material
from simulearn.studio.hops.parameters import MOST, TEXT, Input
from simulearn.studio.hops.values import Inputs

MATERIAL = Input(
    "Material",
    "Mt",
    f"The name of a material ({', '.join(names())}), or the text of your own material's file, "
    "as Read File gives it. If nothing is given, it is the first of these.",
    TEXT,
    0,
    MOST,
)


def made_of(grid: Grid, inputs: Inputs) -> Grid:
    """Return a grid of the material that a component is given, or as it is.

    Raises:
        InputError: it is neither a known name nor the text of a material.
    """
    text = "\n".join(inputs.texts(MATERIAL.name)).strip()
    if not text:
        return grid
    if text in names():
        return replace(grid, material=text)
    if "=" not in text:
        known = ", ".join(names())
        line = f'Material is "{text[:40]}"; it is one of {known}, or the text of a material\'s file'
        raise InputError(line, "material-unknown", MATERIAL.name)
    return replace(grid, material=own_material(text, MATERIAL.name))


def held_by(grid: Grid) -> Mapping[str, Material]:
    """Return by its name the material that a grid holds itself, nothing where it names one."""
    own = grid.material
    return {own.name: own} if isinstance(own, Material) else {}
