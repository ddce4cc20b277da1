"""The package in which Bambu Lab's printers take a print: .gcode.3mf.

A zip file in the layout of the Open Packaging Conventions (ECMA-376, part 2): the G-code with its
checksum, pictures for the display, and a few lists of what it takes. A printer needs no geometry,
so the 3D model in it is empty. Which files and keys there are follows what BambuStudio writes for
"Export plate sliced file" (`libslic3r/Format/bbs_3mf.cpp`), as the documents of bambox 0.6 list it.
The same print gives the same bytes: all files bear the date with which zip's calendar begins.
"""

import json
from hashlib import md5
from math import ceil
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np
from PIL import Image
from shapely import Polygon

from simulearn.errors import InputError
from simulearn.fabricate.header import filament_type, printer_model
from simulearn.fabricate.job import Job
from simulearn.fabricate.markers import object_names, outlines
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.thumbnail import draw, png
from simulearn.files import replacing

# Models by the names and numbers of BambuStudio's profiles (resources/profiles/BBL/machine) and of
# bambox. A printer refuses a package of another model.
MODELS = {
    "Bambu Lab X1 Carbon": "BL-P001",
    "Bambu Lab X1": "BL-P002",
    "Bambu Lab P1P": "C11",
    "Bambu Lab P1S": "C12",
    "Bambu Lab A1 mini": "N1",
    "Bambu Lab A1": "N2S",
    "Bambu Lab H2D": "O1D",
}
# Readers take a package for one of this format by this name; a version that exists.
FORMAT = "02.05.00.66"
SLOTS = 5  # of filament: four of a changer and the spool holder
TRAYS = {"PLA": "GFL99"}  # generic filaments by their numbers
COLOUR = "#CFCFCF"
EPOCH = (1980, 1, 1, 0, 0, 0)
LARGE, SMALL = 512, 128  # pixels
HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
BAMBU = "http://schemas.bambulab.com/package/2021"


def write_package(job: Job, path: Path | str) -> None:
    """Write a print as a package for a Bambu Lab printer, completely or not at all.

    Raises:
        InputError: the printer is not one of theirs, or the file cannot be written.
    """
    number = model_number(job.printer)
    files = _files(job, number)
    with replacing(path) as temporary, ZipFile(temporary, "w", ZIP_DEFLATED) as package:
        for name, contents in files.items():
            entry = ZipInfo(name, EPOCH)
            entry.compress_type = ZIP_DEFLATED
            entry.create_system = 3  # whatever system writes it
            entry.external_attr = 0o644 << 16
            package.writestr(entry, contents)


def model_number(printer: Printer) -> str:
    """Return the number by which a Bambu Lab printer knows files for its model.

    Raises:
        InputError: it is not one of theirs, or its title does not say which.
    """
    if printer.firmware != "bambu":
        raise InputError(
            f"{printer.name} is not a Bambu Lab printer; it reads .gcode, and no .gcode.3mf"
        )
    title = printer_model(printer).lower()
    for model, number in MODELS.items():  # a longer name stands before one that begins it
        if model.lower() in title:
            return number
    raise InputError(
        f'the title of {printer.name} is "{printer.title}"; for a .gcode.3mf it must name the '
        f"model: {', '.join(MODELS)}"
    )


def _files(job: Job, number: str) -> dict[str, str | bytes]:
    """Return the contents of all files by their names."""
    text = job.gcode
    large = png(draw(job.path, (LARGE, LARGE)))
    empty = png(Image.new("RGBA", (LARGE, LARGE)))  # objects cannot be picked from it
    return {
        "[Content_Types].xml": _content_types(),
        "_rels/.rels": _relations(
            ("/3D/3dmodel.model", "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"),
            ("/Metadata/plate_1.png", f"{RELATIONS}/metadata/thumbnail"),
            ("/Metadata/plate_1.png", f"{BAMBU}/cover-thumbnail-middle"),
            ("/Metadata/plate_1_small.png", f"{BAMBU}/cover-thumbnail-small"),
        ),
        "3D/3dmodel.model": _model(),
        "Metadata/plate_1.gcode": text,
        "Metadata/plate_1.gcode.md5": md5(text.encode()).hexdigest().upper(),
        "Metadata/_rels/model_settings.config.rels": _relations(
            ("/Metadata/plate_1.gcode", f"{BAMBU}/gcode")
        ),
        "Metadata/model_settings.config": _model_settings(),
        "Metadata/slice_info.config": _slice_info(job, number),
        "Metadata/project_settings.config": json.dumps(_project(job), indent=4) + "\n",
        "Metadata/plate_1.json": json.dumps(_plate(job), separators=(",", ":")),
        "Metadata/plate_1.png": large,
        "Metadata/plate_no_light_1.png": large,
        "Metadata/plate_1_small.png": png(draw(job.path, (SMALL, SMALL))),
        "Metadata/top_1.png": large,
        "Metadata/pick_1.png": empty,
    }


def _content_types() -> str:
    kinds = {
        "rels": "application/vnd.openxmlformats-package.relationships+xml",
        "model": "application/vnd.ms-package.3dmanufacturing-3dmodel+xml",
        "png": "image/png",
        "gcode": "text/x.gcode",
    }
    space = "http://schemas.openxmlformats.org/package/2006/content-types"
    lines = [f' <Default Extension="{end}" ContentType="{kind}"/>' for end, kind in kinds.items()]
    return HEAD + "\n".join([f'<Types xmlns="{space}">', *lines, "</Types>\n"])


def _relations(*targets: tuple[str, str]) -> str:
    lines = [
        f' <Relationship Target="{target}" Id="rel-{k}" Type="{kind}"/>'
        for k, (target, kind) in enumerate(targets, 1)
    ]
    return HEAD + "\n".join([f'<Relationships xmlns="{RELATIONS}">', *lines, "</Relationships>\n"])


def _model() -> str:
    """Return a model without geometry."""
    space = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    return HEAD + "\n".join(
        [
            f'<model unit="millimeter" xmlns="{space}" xmlns:BambuStudio="{BAMBU}">',
            f' <metadata name="Application">BambuStudio-{FORMAT}</metadata>',
            ' <metadata name="BambuStudio:3mfVersion">1</metadata>',
            " <resources>",
            " </resources>",
            " <build/>",
            "</model>\n",
        ]
    )


def _model_settings() -> str:
    """Return where the files of the one plate lie."""
    return _plates(
        {
            "plater_id": 1,
            "plater_name": "",
            "locked": "false",
            "filament_map_mode": "Auto For Flush",
            "filament_maps": _each(1),
            "filament_volume_maps": _each(0),
            "gcode_file": "Metadata/plate_1.gcode",
            "thumbnail_file": "Metadata/plate_1.png",
            "thumbnail_no_light_file": "Metadata/plate_no_light_1.png",
            "top_file": "Metadata/top_1.png",
            "pick_file": "Metadata/pick_1.png",
            "pattern_bbox_file": "Metadata/plate_1.json",
        }
    )


def _slice_info(job: Job, number: str) -> str:
    """Return what the print takes."""
    needs, settings = job.estimate, job.settings
    kind = filament_type(job.material)
    filament = {
        "id": 1,
        "tray_info_idx": TRAYS.get(kind, ""),
        "type": kind,
        "color": COLOUR,
        "used_m": f"{needs.filament_mm / 1000:.2f}",
        "used_g": f"{needs.filament_g:.2f}",
        "used_for_object": "true",
        "used_for_support": "false",
        "group_id": 0,
        "nozzle_diameter": f"{settings.nozzle:.2f}",
        "volume_type": "Standard",
    }
    objects = [
        {"identify_id": k, "name": name, "skipped": "false"}
        for k, name in enumerate(object_names(job.names), 1)
    ]
    return _plates(
        {
            "index": 1,
            "extruder_type": 0,
            "nozzle_volume_type": 0,
            "printer_model_id": number,
            "nozzle_diameters": f"{settings.nozzle:g}",
            "timelapse_type": 0,
            "prediction": ceil(needs.seconds + needs.heating_seconds),
            "weight": f"{needs.filament_g:.2f}",
            "outside": "false",
            "support_used": "false",
            "label_object_enabled": "false",
            "filament_maps": _each(1),
            "limit_filament_maps": _each(0),
        },
        {"X-BBL-Client-Type": "slicer", "X-BBL-Client-Version": FORMAT},
        [*(_element("object", o) for o in objects), _element("filament", filament)],
    )


def _plates(metadata: dict[str, Any], head: dict[str, str] | None = None, more: Any = ()) -> str:
    """Return a list of facts about the one plate as XML."""
    lines = ["<config>"]
    if head:
        items = [_element("header_item", {"key": k, "value": v}) for k, v in head.items()]
        lines += ["  <header>", *(f"    {item}" for item in items), "  </header>"]
    entries = [_element("metadata", {"key": k, "value": v}) for k, v in metadata.items()]
    lines += ["  <plate>", *(f"    {entry}" for entry in [*entries, *more]), "  </plate>"]
    return HEAD + "\n".join([*lines, "</config>\n"])


def _element(name: str, attributes: dict[str, Any]) -> str:
    pairs = " ".join(f"{key}={quoteattr(str(value))}" for key, value in attributes.items())
    return f"<{name} {pairs}/>"


def _each(value: int) -> str:
    return " ".join([str(value)] * SLOTS)


def _plate(job: Job) -> dict[str, Any]:
    """Return where what lies on the plate."""
    objects = []
    names = object_names(job.names)
    for k, (name, outline) in enumerate(zip(names, outlines(job.path, len(names)), strict=True)):
        box = [*np.min(outline, axis=0).tolist(), *np.max(outline, axis=0).tolist()]
        objects.append(
            {
                "area": round(Polygon(outline).area, 3),
                "bbox": box,
                "id": k + 1,
                "layer_height": job.settings.layer,
                "name": name,
            }
        )
    boxes = np.array([each["bbox"] for each in objects])
    return {
        "bbox_all": [*boxes[:, :2].min(axis=0).tolist(), *boxes[:, 2:].max(axis=0).tolist()],
        "bbox_objects": objects,
        "bed_type": "textured_plate",
        "filament_colors": [COLOUR],
        "filament_ids": [0],
        "first_extruder": 0,
        "is_seq_print": False,
        "nozzle_diameter": job.settings.nozzle,
        "version": 2,
    }


def _project(job: Job) -> dict[str, Any]:
    """Return the settings that are known; BambuStudio has hundreds more, of slicing."""
    settings, kind = job.settings, filament_type(job.material)
    return {
        "from": "project",
        "name": "project_settings",
        "version": FORMAT,
        "printer_model": printer_model(job.printer),
        "printer_settings_id": f"{printer_model(job.printer)} {settings.nozzle:g} nozzle",
        "nozzle_diameter": [f"{settings.nozzle:g}"],
        "layer_height": f"{settings.layer:g}",
        "filament_type": [kind] * SLOTS,
        "filament_colour": [COLOUR] * SLOTS,
        "filament_diameter": [f"{settings.filament:g}"] * SLOTS,
        "filament_density": [f"{settings.density * 1000:g}"] * SLOTS,
        "nozzle_temperature": [f"{settings.temperature:.0f}"] * SLOTS,
        "nozzle_temperature_initial_layer": [f"{settings.temperature:.0f}"] * SLOTS,
        "hot_plate_temp": [f"{settings.bed:.0f}"] * SLOTS,
        "textured_plate_temp": [f"{settings.bed:.0f}"] * SLOTS,
    }
