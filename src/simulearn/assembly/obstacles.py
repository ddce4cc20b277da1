"""The surfaces of an assembly's obstacles, in their places."""

from simulearn.assembly.assembly import Assembly, wrong
from simulearn.errors import InputError
from simulearn.surfaces import Surface, read_surface


def surfaces(assembly: Assembly) -> dict[str, Surface]:
    """Return the surfaces of the obstacles in their places, by name.

    Raises:
        InputError: a file cannot be read or holds no surface; one line says which.
    """
    found = {}
    for k, one in enumerate(assembly.obstacles):
        try:
            surface = read_surface(one.file, one.unit)
        except InputError as error:
            if error.code == "unit-name":
                raise wrong(f"obstacles[{k}].unit", f"is wrong: {error}") from error
            text = f"obstacles[{k}].file: {error}"
            raise InputError(text, error.code, error.where) from error
        found[one.name] = surface.placed(one.place)
    return found
