"""Words of slicers in a profile's code, which only they fill in, and what they are called here.

A slicer writes [first_layer_temperature] or {first_layer_temperature[0]}. Sent to a printer as it
stands, such a line is an error at best and a heater at 0 C at worst.
"""

import re

from simulearn.errors import InputError

BRACKET = re.compile(r"\[\s*([A-Za-z_]\w*)[^\]]*\]")
BRACE = re.compile(r"\{([^{}]*)\}")
NAME = re.compile(r"[A-Za-z_]\w*")
# By PrusaSlicer and SuperSlicer, Orca and Bambu Studio, Cura; those of a list without its index.
OURS = {
    "first_layer_temperature": "temperature",
    "temperature": "temperature",
    "nozzle_temperature": "temperature",
    "nozzle_temperature_initial_layer": "temperature",
    "material_print_temperature": "temperature",
    "material_print_temperature_layer_0": "temperature",
    "extruder_temperature": "temperature",
    "first_layer_bed_temperature": "bed",
    "bed_temperature": "bed",
    "bed_temperature_initial_layer": "bed",
    "bed_temperature_initial_layer_single": "bed",
    "hot_plate_temp_initial_layer": "bed",
    "material_bed_temperature": "bed",
    "material_bed_temperature_layer_0": "bed",
    "nozzle_diameter": "nozzle",
    "machine_nozzle_size": "nozzle",
    "filament_diameter": "filament",
    "material_diameter": "filament",
    "layer_height": "layer",
    "first_layer_height": "layer",
    "initial_layer_print_height": "layer",
    "max_layer_z": "top",
    "layer_z": "top",
    "max_print_height": "bed_max_z",
    "machine_height": "bed_max_z",
    "machine_width": "bed_max_x",
    "machine_depth": "bed_max_y",
}
CORNERS = {
    ("first_layer_print_min", "0"): "min_x",
    ("first_layer_print_min", "1"): "min_y",
    ("first_layer_print_max", "0"): "max_x",
    ("first_layer_print_max", "1"): "max_y",
    ("first_layer_print_size", "0"): "size_x",
    ("first_layer_print_size", "1"): "size_y",
    ("print_bed_min", "0"): "bed_min_x",
    ("print_bed_min", "1"): "bed_min_y",
    ("print_bed_max", "0"): "bed_max_x",
    ("print_bed_max", "1"): "bed_max_y",
}


def filled(code: str, words: dict[str, str], where: str) -> str:
    """Return a line's code with the words in braces filled in.

    Args:
        code: a line without its comment.
        words: what is known here, and how it is written.
        where: the line's place, for messages.

    Raises:
        InputError: it has a word of a slicer, or one that is not known.
    """
    if (bracket := BRACKET.search(code)) is not None:
        raise InputError(f"{where}: {bracket[0]} {_a_slicers(bracket[0], words)}")
    for brace in BRACE.finditer(code):
        if brace[1] in words:
            continue
        if any(name in OURS or (name, "0") in CORNERS for name in NAME.findall(brace[1])):
            raise InputError(f"{where}: {brace[0]} {_a_slicers(brace[0], words)}")
        if not brace[1].isidentifier():
            raise InputError(f"{where}: {brace[0]} is computed by slicers only; {_known(words)}")
        raise InputError(f"{where}: {brace[0]} is not known; {_known(words)}")
    return BRACE.sub(lambda brace: words[brace[1]], code)


def _a_slicers(text: str, words: dict[str, str]) -> str:
    names = NAME.findall(text)
    for name in names:
        if name in OURS:
            return f"is a slicer's placeholder; write {{{OURS[name]}}}"
        index = re.search(rf"{name}\s*\[\s*([01])", text)
        if index is not None and (ours := CORNERS.get((name, index[1]))):
            return f"is a slicer's placeholder; write {{{ours}}}"
    return f"is a slicer's placeholder, which nobody fills in here; {_known(words)}"


def _known(words: dict[str, str]) -> str:
    return f"words are {', '.join(words)}"
