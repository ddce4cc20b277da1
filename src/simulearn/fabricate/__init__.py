"""From grid to print: toolpaths, printers, estimates and G-code."""

from simulearn.fabricate.estimate import Estimate
from simulearn.fabricate.gcode import write_gcode
from simulearn.fabricate.job import Job, prepare
from simulearn.fabricate.package import model_number, write_package
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.profiles import load_printer, printers, profile_text, read_profile
from simulearn.fabricate.settings import Settings, extrusion, settings_of
from simulearn.fabricate.toolpath import ROLES, Bead, Layer, Toolpath, toolpath_to_dict

__all__ = [
    "ROLES",
    "Bead",
    "Estimate",
    "Job",
    "Layer",
    "Printer",
    "Settings",
    "Toolpath",
    "extrusion",
    "load_printer",
    "model_number",
    "prepare",
    "printers",
    "profile_text",
    "read_profile",
    "settings_of",
    "toolpath_to_dict",
    "write_gcode",
    "write_package",
]
