"""G-code: the file that prints a grid."""

from simulearn.errors import InputError
from simulearn.fabricate import load_printer, prepare, printers
from simulearn.studio.downloads import safe_stem
from simulearn.studio.hops.components.shared import texts
from simulearn.studio.hops.design import DRAWN, design_of
from simulearn.studio.hops.material import MATERIAL
from simulearn.studio.hops.parameters import NUMBER, TEXT, Component, Input, Output
from simulearn.studio.hops.solving import Context, Outputs
from simulearn.studio.hops.values import Exact, Inputs

PRINTER = Input(
    "Printer",
    "P",
    f"The printer: {', '.join(printers())}.",
    TEXT,
    default="ender-3",
)
NAME = Input("Name", "N", "A name for the file.", TEXT, default="grid")


def run(inputs: Inputs, context: Context) -> Outputs:
    """Return the print of a grid.

    Hops leaves the ends of lines in a text as it finds them in JSON, so each line is a text.
    """
    design = design_of(inputs, context.modelunits, context.app.state.settings)
    name = inputs.text(PRINTER.name, str(PRINTER.default))
    if name not in printers():
        text = f'printer "{name[:40]}" is not known; known are {", ".join(printers())}'
        raise InputError(text, "printer-unknown", PRINTER.name)
    stem = safe_stem(inputs.text(NAME.name, str(NAME.default)))
    job = prepare([design.grid], load_printer(name), [stem])
    warnings = texts(job.warnings)
    return Outputs(
        {
            "Text": [Exact(line) for line in job.gcode.splitlines()],
            "File": [f"{stem}.gcode"],
            "Time": [job.estimate.seconds],
            "Heating": [job.estimate.heating_seconds],
            "Filament": [job.estimate.filament_mm],
            "Mass": [job.estimate.filament_g],
            "Messages": [*warnings, *design.texts],
        },
        warnings=[*warnings, *design.warnings],
    )


COMPONENT = Component(
    "gcode",
    "G-code",
    "The file that prints a grid.",
    (*DRAWN, PRINTER, NAME, MATERIAL),
    (
        Output("Text", "T", "The file, line by line.", TEXT),
        Output("File", "F", "A name for the file.", TEXT),
        Output("Time", "S", "From the first move to the last, s.", NUMBER),
        Output("Heating", "H", "Before that, from room temperature, s.", NUMBER),
        Output("Filament", "L", "Length of filament, mm.", NUMBER),
        Output("Mass", "G", "Mass of filament, g.", NUMBER),
        Output(
            "Messages", "M", "What may be wrong with the print, mends, what was left out.", TEXT
        ),
    ),
    run,
)
