"""Words of slicers in start and end code, and what SimuLearn calls them.

Code that was copied from a slicer has its placeholders: [first_layer_temperature],
{nozzle_temperature_initial_layer[0]}, {max_layer_z + 2}. Only words in braces are filled in here,
and nothing is computed; a placeholder that reached a printer would be read as something else.
"""

import re

from simulearn.errors import InputError

BRACES = re.compile(r"\{([^{}]*)\}")
BRACKETS = re.compile(r"\[([A-Za-z_][^\[\]]*(?:\[[^\[\]]*\][^\[\]]*)*)\]")
NAME = re.compile(r"[A-Za-z_]\w*(?:\s*\[\s*\d+\s*\])?")
KEYWORDS = {"if", "else", "elsif", "elif", "endif", "and", "or", "not", "min", "max", "int"}

# Ours, and the names of PrusaSlicer, OrcaSlicer, BambuStudio, Cura, Simplify3D and ideaMaker.
NAMES = {
    "temperature": (
        "first_layer_temperature",
        "nozzle_temperature",
        "nozzle_temperature_initial_layer",
        "material_print_temperature",
        "material_print_temperature_layer_0",
        "extruder0_temperature",
        "temperature_extruder1",
    ),
    "bed": (
        "first_layer_bed_temperature",
        "bed_temperature",
        "bed_temperature_initial_layer",
        "bed_temperature_initial_layer_single",
        "hot_plate_temp",
        "hot_plate_temp_initial_layer",
        "material_bed_temperature",
        "material_bed_temperature_layer_0",
        "bed0_temperature",
        "temperature_heatbed",
    ),
    "nozzle": ("nozzle_diameter", "machine_nozzle_size"),
    "filament": ("filament_diameter", "material_diameter"),
    "layer": (
        "layer_height",
        "first_layer_height",
        "initial_layer_print_height",
        "layer_height_0",
    ),
    "top": ("max_layer_z", "layer_z"),
    "min_x": ("first_layer_print_min[0]",),
    "min_y": ("first_layer_print_min[1]",),
    "max_x": ("first_layer_print_max[0]",),
    "max_y": ("first_layer_print_max[1]",),
    "size_x": ("first_layer_print_size[0]",),
    "size_y": ("first_layer_print_size[1]",),
    "bed_min_x": ("print_bed_min[0]",),
    "bed_min_y": ("print_bed_min[1]",),
    "bed_max_x": ("print_bed_max[0]", "machine_width"),
    "bed_max_y": ("print_bed_max[1]", "machine_depth"),
    "bed_max_z": ("max_print_height", "printable_height", "machine_height"),
}
OURS = {name: word for word, names in NAMES.items() for name in names}


def fill(code: str, words: dict[str, str], where: str) -> str:
    """Return code with its words in braces filled in.

    Args:
        code: a line without its comment.
        words: what may be filled in.
        where: what to call the line in messages.

    Raises:
        InputError: a word is not known, or is a placeholder of a slicer.
    """
    for match in BRACES.finditer(code):
        if match[1] not in words:
            raise InputError(f"{where}: {match[0]} {_reason(match[1], words)}")
    filled = BRACES.sub(lambda match: words[match[1]], code)
    if bracket := BRACKETS.search(filled):
        raise InputError(f"{where}: {bracket[0]} {_reason(bracket[1], words)}")
    return filled


def fill_comment(comment: str, words: dict[str, str]) -> str:
    """Return a comment with the words that are known filled in; it may hold any brackets."""
    return BRACES.sub(lambda match: words.get(match[1], match[0]), comment)


def our_word(name: str) -> str | None:
    """Return our word for a slicer's name, or None; an index that picks no axis is left out."""
    bare = re.sub(r"\s*\[.*", "", name)
    if bare in ("temperature", *OURS):
        return OURS.get(bare, bare)
    return OURS.get(re.sub(r"\s", "", name))


def _reason(inside: str, words: dict[str, str]) -> str:
    known = f"words are {', '.join(words)}"
    inside = inside.strip()
    names = [name for name in NAME.findall(inside) if name not in KEYWORDS]
    whole = re.fullmatch(r"\w+\s*(\[\s*\w+\s*\])?(\s*,\s*\w+)?", inside) is not None
    found = {name: word for name in names if (word := our_word(name))}
    if whole and found:
        return f"is a slicer's placeholder; write {{{next(iter(found.values()))}}}"
    if whole and "[" in inside:
        return f"is a slicer's placeholder, for which there is no word here; {known}"
    if whole:
        return f"is not known; {known}"
    if found:
        hints = ", ".join(f"{{{word}}} for {name}" for name, word in found.items())
        return f"is a slicer's expression, which is not computed here; write a number, or {hints}"
    return f"is a slicer's expression, which is not computed here; write a number; {known}"
