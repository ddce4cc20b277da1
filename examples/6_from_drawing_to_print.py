# %% [markdown]
# # 6. From a drawing to the printer
#
# A drawing made elsewhere (here `leaf.svg`; DXF and Rhino files go the same way) becomes a grid, is
# checked, simulated, and turned into the file that the printer reads. Needs
# `pip install 'simulearn[rhino]'`.

# %%
# ruff: noqa: B018, D100  (a name at the end of a cell is what the notebook shows)
import os
from pathlib import Path

from simulearn import outputs, simulate, validate
from simulearn.drawings.importing import Options, imported
from simulearn.fabricate import load_printer, prepare, write_gcode
from simulearn.files import replacing
from simulearn.grid import write_grid
from simulearn.show import toolpath

SMALL = bool(os.environ.get("SIMULEARN_SMALL"))
OUT = Path("out/6_from_drawing_to_print")
OUT.mkdir(parents=True, exist_ok=True)
# The drawing lies beside this file; a notebook runs in the folder where it lies.
FOLDER = Path(globals().get("__file__", "here")).parent

# %% [markdown]
# ## Read the drawing
# Lines become beams, and joints lie where lines meet or cross. The names of the drawing's layers
# say which beams curl: `top 0.5` is an actuator in the upper half along half of the beam. Whatever
# is mended, left out or taken for something is reported; nothing happens silently.

# %%
drawing = FOLDER / "leaf.svg"
read = imported(drawing.read_bytes(), drawing.name, Options())
print(f"{read.format}, in {read.unit.name} ({read.unit.source})")
for layer in read.layers:
    print(f'layer "{layer.name}": {layer.lines} lines, actuator {layer.ratio}')
for mend in read.mends:
    print(f"mended: {mend.message}")
for message in read.messages:
    print(message.message)
grid = read.grid
write_grid(grid, OUT / "grid.json")
grid

# %% [markdown]
# ## Check and simulate

# %%
report = validate(grid)
for message in (*report.errors, *report.warnings):
    print(message.where, "-", message.message)
assert report.valid

# %%
result = simulate(grid, engine="beams" if SMALL else "fea")
for warning in result.warnings:
    print("warning:", warning.message)
outputs.write(result, OUT / "shape.png")
result

# %% [markdown]
# ## Print
# `simulearn printers` lists the printers that are known; a profile of your own is a text file. The
# path of the nozzle is checked before anything is written: it stays on the bed, and where an
# actuator lies the strokes run along the beam, elsewhere across it.

# %%
job = prepare([grid], load_printer("prusa-mk4"), ["leaf"])
minutes, grams = job.estimate.seconds / 60, job.estimate.filament_g
print(f"{len(job.path.layers)} layers, {minutes:.0f} min, {grams:.0f} g of filament")
for warning in job.warnings:
    print("warning:", warning.message)
write_gcode(job.gcode, OUT / "leaf.gcode")
with replacing(OUT / "toolpath.png") as temporary:
    toolpath.layers(job.path, "leaf").savefig(temporary)
print("wrote", ", ".join(sorted(path.name for path in OUT.iterdir())))
