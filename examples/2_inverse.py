# %% [markdown]
# # 2. From a shape to the grid
#
# You know where some points of the finished piece should be, and look for the flat grid that comes
# there. A task holds a grid to begin with, goals, and what may change. The search tries designs
# with the learned engine and checks the best of them by finite elements.

# %%
# ruff: noqa: B018, D100  (a name at the end of a cell is what the notebook shows)
import os
from pathlib import Path

from simulearn import make, optimize, outputs, rank
from simulearn.grid import grid_to_dict, write_grid
from simulearn.inverse import task_from_dict

SMALL = bool(os.environ.get("SIMULEARN_SMALL"))
OUT = Path("out/2_inverse")
OUT.mkdir(parents=True, exist_ok=True)
ENGINE = "beams" if SMALL else "learned"

# %% [markdown]
# ## What is wanted
# We begin with a flat square of 2 by 2 cells and want its four corners to come up by 25 mm, and a
# little inwards. Targets are in millimetres, seen from the fixed joint, which is the middle one.

# %%
start = make("flat", (1, 1) if SMALL else (2, 2), 60.0).centred
corners = [3] if SMALL else [0, 2, 6, 8]
goals = [
    {"vertex": ["joint", k, "centre"], "target": [*(0.85 * start.joints[k]).tolist(), 25.0]}
    for k in corners
]
task = task_from_dict(
    {
        "schema": "simulearn.task/1",
        "grid": grid_to_dict(start),
        "goals": goals,
        "engine": ENGINE,
        "limits": {"seconds": 2 if SMALL else 30, "corrections": 0 if SMALL else 2},
    }
)
start

# %% [markdown]
# ## Step by step: suggestions
# `rank` tries every single change, and suggests five that differ. It is the way to stay in charge:
# choose one, look, and rank again.

# %%
ranking = rank(task)
print(f"{ranking.error_mm:.1f} mm away as it is")
for suggestion in ranking.best:
    print(f"  {suggestion.change.words}: {suggestion.error_mm:.1f} mm")
ranking

# %% [markdown]
# ## All at once: search
# `optimize` goes on until it comes near, or until its time is over. Where a target cannot be
# reached, a warning says so, and why.

# %%
found = optimize(task, progress=lambda step: print(f"{step.error_mm:.2f} mm: {step.words}"))
for warning in found.warnings:
    print("warning:", warning.message)
print(f"{found.error_mm:.2f} mm away by the engine {ENGINE}")
if found.check is not None and found.check.error_fea_mm is not None:
    print(f"{found.check.error_fea_mm:.2f} mm away by finite elements")
found

# %% [markdown]
# ## Save

# %%
write_grid(found.grid, OUT / "best.json")
if found.check is not None and found.check.shape is not None:
    outputs.write(found.check.shape, OUT / "best.png")
found.grid
