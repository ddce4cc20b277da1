"""Fitting a material to measured prints: a plate of strips, a form, and a fit."""

from simulearn.calibrate.fit import Difference, Estimate, Fit, fit
from simulearn.calibrate.form import Form, StripRecord, parse_form, read_form
from simulearn.calibrate.formtext import form_text, write_form
from simulearn.calibrate.materialfile import material_text, write_material
from simulearn.calibrate.plate import Plate, label, make_plate

__all__ = [
    "Difference",
    "Estimate",
    "Fit",
    "Form",
    "Plate",
    "StripRecord",
    "fit",
    "form_text",
    "label",
    "make_plate",
    "material_text",
    "parse_form",
    "read_form",
    "write_form",
    "write_material",
]
