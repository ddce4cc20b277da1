# %% [markdown]
# # 4. Your own learned model
#
# A learned model answers in milliseconds what finite elements answer in seconds. It learns from a
# data set: random designs and their simulated shapes. Here all steps are done at a size that takes
# some minutes; the models that come along learnt from 1,600 designs. The command line does the
# same: `simulearn dataset generate` and `pack`, `simulearn train`, `simulearn evaluate`.

# %%
# ruff: noqa: B018, D100  (a name at the end of a cell is what the notebook shows)
import os
from pathlib import Path

from simulearn import simulate
from simulearn.dataset import config_of, generate, local_workers, pack, read_dataset
from simulearn.files import cores
from simulearn.learn.common.evaluate import evaluate, for_testing
from simulearn.learn.config import config_of as training_of
from simulearn.learn.run import run

SMALL = bool(os.environ.get("SIMULEARN_SMALL"))
OUT = Path("out/4_own_model")
OUT.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## Designs and their shapes
# A few lines say what the designs are like: here single cells, every fourth kept for testing. If
# the run is stopped, the same lines go on where it was.

# %%
config = config_of(
    {
        "name": "my-cells",
        "trials": 4 if SMALL else 60,
        "seed": 1,
        "test_every": 4,
        "rules": {"cells": [1, 1]},
        "solver": {"slabs": 4},
    },
    "my-cells",
)
workers = local_workers(1 if SMALL else cores())
tally = generate(config, OUT / "trials", workers)
print(f"{tally.present + tally.done} designs, {tally.failed} without a shape")
pack(OUT / "trials", OUT / "my-cells.h5")

# %% [markdown]
# ## Train
# The kind `beams` knows the mechanics of beams and learns how stiff the printed section is and how
# much it bends: 40 numbers. It needs few designs. The kind `equilibrium` adds a network that learns
# what is left, and needs many.

# %%
training = training_of(
    {
        "name": "my-model",
        "kind": "beams",
        "data": str(OUT / "my-cells.h5"),
        "validation": 1 if SMALL else 8,
        "law": {"updates": 1 if SMALL else 200, "batch": 2 if SMALL else 16, "rate": 0.05},
    },
    "my-model",
)
data = read_dataset(OUT / "my-cells.h5", "train")
bundle, rows, percent = run(training, data, OUT, lambda row, done, total: None)
print(f"trained in {len(rows)} steps; {percent:.2f} % off on designs set aside")

# %% [markdown]
# ## Judge
# The designs kept for testing have not been seen by the training. The error is the mean distance of
# the vertices from their true places, in percent of the grid's dimension.

# %%
evaluation = evaluate(bundle.model, for_testing(read_dataset(OUT / "my-cells.h5")))
print(f"mean error {evaluation.errors.summary()['mean_percent']:.2f} % of the dimension")

# %% [markdown]
# ## Use
# The folder of the model goes wherever a model is asked for, also on the command line:
# `simulearn simulate grid.json --engine learned --model out/4_own_model/model`.

# %%
grid = read_dataset(OUT / "my-cells.h5").batches[0].grid(0)
result = simulate(grid, engine="learned", model=bundle.path)
print(f"{result.engine} by {result.model}: {result.seconds:.2f} s")
result
