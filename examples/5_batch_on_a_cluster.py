# %% [markdown]
# # 5. Many designs at once, here or on a cluster
#
# One design is simulated in seconds, a thousand in an hour, and on ten machines in minutes. First
# many designs in one call on this machine; then a data set computed by the workers of a Dask
# cluster. Needs `pip install 'simulearn[cluster]'`.

# %%
# ruff: noqa: D100
import csv
import os
from pathlib import Path

from simulearn import Failure, Grid, make, simulate
from simulearn.dataset import cluster_workers, config_of, generate

SMALL = bool(os.environ.get("SIMULEARN_SMALL"))
OUT = Path("out/5_batch_on_a_cluster")
OUT.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## Many designs in one call
# How much does a saddle bend if its actuators are shorter? A design that is not valid, or has no
# shape, does not stop the others: in its place stands a `Failure` that says why.

# %%
plain = make("saddle", (1, 1) if SMALL else (2, 2), 60.0)
shares = [0.01 * k for k in range(0, 101, 50 if SMALL else 5)]
grids = [Grid(plain.joints, plain.beams, share * plain.actuators, plain.fixed) for share in shares]
outcomes = simulate(grids, engine="beams")
rows = []
for share, outcome in zip(shares, outcomes, strict=True):
    if isinstance(outcome, Failure):
        print(f"{share:.0%}: no shape, {outcome.message}")
    else:
        z = outcome.centres[-1][:, 2]
        rows.append((share, float(z.max() - z.min())))
        print(f"{share:.0%}: {rows[-1][1]:.1f} mm")
with (OUT / "rise.csv").open("w", newline="", encoding="utf-8") as table:
    csv.writer(table).writerows([("share", "rise_mm"), *rows])

# %% [markdown]
# ## A cluster
# On a real cluster, one machine runs `dask scheduler` and the others `dask worker tcp://HOST:8786`;
# all have the same version of SimuLearn. For trying out, a cluster inside this program will do. The
# same on the command line: `simulearn dataset generate CONFIG -o DIR --scheduler tcp://HOST:8786`.

# %%
address = os.environ.get("SIMULEARN_SCHEDULER", "")  # tcp://HOST:8786 of a cluster of your own
if address:
    cluster = None
else:
    from distributed import LocalCluster

    # A single process, since this is only a try; `processes=True` makes several.
    cluster = LocalCluster(n_workers=1, processes=False, protocol="tcp://", dashboard_address=None)
    address = cluster.scheduler_address
print("the scheduler is at", address)

# %% [markdown]
# ## A data set by its workers
# Every finished design is a file of its own. Stop whenever you like: the same lines go on. Workers
# that die lose only what they were at.

# %%
config = config_of(
    {
        "name": "cells",
        "trials": 2 if SMALL else 40,
        "rules": {"cells": [1, 1]},
        "solver": {"slabs": 4},
    },
    "cells",
)
tally = generate(
    config,
    OUT / "trials",
    cluster_workers(address),
    lambda tally: print(f"{tally.trials - tally.left} of {tally.trials}"),
)
for reason in tally.reasons:
    print("no shape:", reason)
if cluster is not None:
    cluster.close()
print(f"{tally.present + tally.done} trials in {OUT / 'trials'}")
print("`simulearn dataset pack` joins them into one file")
