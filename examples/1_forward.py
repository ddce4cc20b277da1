# %% [markdown]
# # 1. From a flat grid to its shape
#
# A grid is printed flat. Laid in hot water, its beams curl and the grid takes another shape. Here
# you draw a grid by its numbers, check it, see the shape it takes, and save what you need.
#
# Run it with `python examples/1_forward.py`, or cell by cell in a notebook.

# %%
# ruff: noqa: B018, D100  (a name at the end of a cell is what the notebook shows)
import os
from pathlib import Path

from simulearn import Grid, outputs, simulate, validate
from simulearn.grid import write_grid

SMALL = bool(os.environ.get("SIMULEARN_SMALL"))  # set by the tests, which are in a hurry
OUT = Path("out/1_forward")
OUT.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## Draw
# `joints` are places in millimetres; `beams` say which two joints each beam connects, counted from
# 0. An `actuator` is the part of a beam that shrinks most: 1 is the whole length, 0.5 the middle
# half, 0 none of it. With + it lies in the upper half of the beam, which then curls up, with - in
# the lower half. One joint is held.

# %%
joints = [[0, 0], [65, 0], [130, 0], [0, 65], [65, 65], [130, 65]]
beams = [[0, 1], [1, 2], [3, 4], [4, 5], [0, 3], [1, 4], [2, 5]]
actuators = [1.0, 1.0, 0.5, 0.5, 0, -0.75, 0]
grid = Grid(joints, beams, actuators, fixed=1)
grid

# %% [markdown]
# ## Check
# Errors keep a grid from being simulated; warnings do not. Each names the beam or joint.

# %%
report = validate(grid)
print("valid" if report.valid else "not valid")
for message in (*report.errors, *report.warnings):
    print(message.where, "-", message.message)

# %% [markdown]
# ## Simulate
# The engine `learned` answers in a moment and says how far off it may be. The engine `fea` computes
# the shape by finite elements; it takes some seconds and is what all others are compared with.
# In a notebook the result plays: drag to turn it, move the slider from flat to morphed.

# %%
result = simulate(grid, engine="beams" if SMALL else "learned")
lowest, highest = result.centres[-1][:, 2].min(), result.centres[-1][:, 2].max()
print(f"the joints end between {lowest:.1f} and {highest:.1f} mm above the bed")
if result.bound_mm is not None:
    print(f"nine of ten such answers are off by less than {result.bound_mm:.1f} mm")
for warning in result.warnings:
    print("warning:", warning.message)
result

# %%
if not SMALL:
    exact = simulate(grid, engine="fea")
    apart = ((exact.centres[-1] - result.centres[-1]) ** 2).sum(axis=1).max() ** 0.5
    print(f"finite elements agree to {apart:.1f} mm at the joint that differs most")

# %% [markdown]
# ## Save
# The ending of a name chooses the format: a picture, a surface for 3D programs, all numbers.

# %%
write_grid(grid, OUT / "grid.json")
for name in ["shape.png", "shape.json", "shape.stl"]:
    outputs.write(result, OUT / name)
print("wrote", ", ".join(sorted(path.name for path in OUT.iterdir())))
