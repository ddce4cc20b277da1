"""What a file tells the machine between beads: which layer it is on, and which object.

Layers are for its display. Objects are for people who stop one of several grids while the others go
on: everything between the start and the end of an object is then left out, travels included. The
skirt belongs to no object, a brim to the grid that it holds.

Sources: Klipper `klippy/extras/exclude_object.py` and `print_stats.py`; RepRapFirmware 3.5
`GCodes5.cpp`; Prusa-Firmware-Buddy `marlin_stubs/M486.cpp` (a name stands in a line of its own);
Marlin `gcode/feature/cancel/M486.cpp` (names are not known: their capitals would be taken for
parameters); BambuStudio's `layer_change_gcode` of the X1.
"""

import json
import re
from collections.abc import Iterator, Sequence

import numpy as np
from shapely import MultiPoint

from simulearn.fabricate.printer import Firmware
from simulearn.fabricate.toolpath import BRIM, Layer, Toolpath

LONGEST = 60  # letters of a name
NOTHING = -1  # the object of what belongs to none
COUNTED = ("marlin", "prusa", "reprap")  # firmware that numbers objects (M486)


def object_names(names: Sequence[str]) -> list[str]:
    """Return names that every firmware reads: letters, digits and underscores, no two alike."""
    safe: list[str] = []
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9_]+", "_", name).strip("_")[:LONGEST] or "grid"
        number, whole = 1, plain
        while whole.upper() in [other.upper() for other in safe]:  # Klipper writes them large
            number += 1
            whole = f"{plain}_{number}"
        safe.append(whole)
    return safe


def outlines(path: Toolpath, count: int) -> list[list[list[float]]]:
    """Return the convex outlines of the objects without their brims, each a list of [x, y], mm."""
    found = []
    all_beads = [b for layer in path.layers for b in layer.beads if b.role != BRIM]
    for k in range(count):
        beads = [b.points for b in all_beads if b.grid == k]
        hull = MultiPoint(np.unique(np.concatenate(beads).round(3), axis=0)).convex_hull
        places = np.array(hull.exterior.coords)[:-1]
        found.append(places.round(3).tolist())
    return found


def objects_info(path: Toolpath, names: Sequence[str]) -> str:
    """Return names and outlines of the objects as PrusaSlicer writes them, one line of JSON."""
    whole = zip(object_names(names), outlines(path, len(names)), strict=True)
    objects = [{"name": name, "polygon": outline} for name, outline in whole]
    return json.dumps({"objects": objects}, separators=(",", ":"))


def definitions(path: Toolpath, names: Sequence[str], firmware: Firmware) -> Iterator[str]:
    """Yield what tells the machine of all objects, if there are several and it knows any."""
    if len(names) < 2:
        return
    safe = object_names(names)
    if firmware == "klipper":
        for name, outline in zip(safe, outlines(path, len(names)), strict=True):
            low, high = np.min(outline, axis=0), np.max(outline, axis=0)
            x, y = (low + high) / 2
            polygon = json.dumps(outline, separators=(",", ":"))
            yield f"EXCLUDE_OBJECT_DEFINE NAME={name} CENTER={x:.3f},{y:.3f} POLYGON={polygon}"
    elif firmware in COUNTED:
        yield f"M486 T{len(names)}"
        for k, name in enumerate(safe):
            if firmware == "prusa":
                yield f"M486 S{k}"
                yield f"M486 A{name}"
            elif firmware == "reprap":
                yield f'M486 S{k} A"{name}"'
        yield "M486 S-1"


def change(names: Sequence[str], firmware: Firmware, last: int, now: int) -> Iterator[str]:
    """Yield what leads from one object to another; `NOTHING` is none."""
    if len(names) < 2 or last == now:
        return
    if firmware == "klipper":
        safe = object_names(names)
        if last != NOTHING:
            yield f"EXCLUDE_OBJECT_END NAME={safe[last]}"
        if now != NOTHING:
            yield f"EXCLUDE_OBJECT_START NAME={safe[now]}"
    elif firmware in COUNTED:
        yield f"M486 S{now}"


def all_layers(path: Toolpath, firmware: Firmware) -> Iterator[str]:
    """Yield what tells the machine how many layers there are."""
    if firmware == "klipper":
        yield f"SET_PRINT_STATS_INFO TOTAL_LAYER={len(path.layers)}"


def layer(number: int, count: int, what: Layer, firmware: Firmware) -> Iterator[str]:
    """Yield what tells the machine and its viewers that a layer begins.

    Args:
        number: of the layer, from 0.
        count: of all layers.
        what: the layer.
        firmware: of the machine.
    """
    if firmware == "bambu":
        yield "; CHANGE_LAYER"
        yield f"; Z_HEIGHT: {what.z:g}"
        yield f"; LAYER_HEIGHT: {what.height:g}"
        yield f"; layer num/total_layer_count: {number + 1}/{count}"
        yield f"M73 L{number + 1}"
        yield f"M991 S0 P{number}"
    elif firmware == "klipper":
        yield f"SET_PRINT_STATS_INFO CURRENT_LAYER={number + 1}"
