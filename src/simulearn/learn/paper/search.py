"""Searching the hyperparameters of the paper's Figure 9: noise, penalty and size of the data.

Each run is a short training with the phases of the configuration; which combination is tried next
is decided by Optuna from those before, and none is tried twice. The runs are saved, so a search
goes on where it was stopped.
"""

import json
from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from simulearn.dataset import Dataset
from simulearn.errors import InputError
from simulearn.extras import require
from simulearn.files import read_text, replacing
from simulearn.learn.common.first_frame import designs_of
from simulearn.learn.common.metrics import errors, together
from simulearn.learn.common.trials import fingerprint, split
from simulearn.learn.paper.config import PaperConfig, Phase
from simulearn.learn.paper.train import train

NOISE = (0.0, 0.03, 0.1, 0.3)
PENALTY = (0.0, 0.1, 1.0, 10.0)
SHARES = (0.25, 0.5, 1.0)  # of the configuration's trials
COLUMNS = ("noise", "penalty", "trials", "validation_percent", "gap_mm")


def search(
    config: PaperConfig,
    data: Dataset,
    folder: Path,
    runs: int,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> dict[str, Any]:
    """Run a search and return all runs and the best of them.

    Args:
        config: of each run, but for noise and penalty; its trials are the most.
        data: to learn from.
        folder: where search.json and search.csv are written; it exists.
        runs: how many in all; at most as many as there are combinations.
        progress: called with (runs done, runs in all).

    Raises:
        InputError: Optuna is not installed, or the folder holds another search.
    """
    require("--search needs", "optuna")
    import optuna

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    identity = fingerprint(config, data)
    file = folder / "search.json"
    rows: list[dict[str, Any]] = []
    if file.exists():
        saved = json.loads(read_text(file))
        if saved.get("identity") != identity:
            raise InputError(f"{file}: is of another search; name another folder")
        rows = saved["runs"]
    available = config.trials or sum(int((~b.test).sum()) for b in data.batches)
    sizes = sorted({max(2 * config.validation, round(share * available)) for share in SHARES})
    space: dict[str, optuna.distributions.BaseDistribution] = {
        "noise": optuna.distributions.CategoricalDistribution(NOISE),
        "penalty": optuna.distributions.CategoricalDistribution(PENALTY),
        "trials": optuna.distributions.CategoricalDistribution(sizes),
    }
    combinations = [dict(zip(space, c, strict=True)) for c in product(NOISE, PENALTY, sizes)]

    def known(row: dict[str, Any]) -> optuna.trial.FrozenTrial:
        return optuna.trial.create_trial(
            params={name: row[name] for name in space},
            distributions=space,
            value=row["validation_percent"],
        )

    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=config.seed))
    for row in rows:
        study.add_trial(known(row))
    progress(len(rows), runs)
    for k in range(len(rows), runs):
        # A sampler of its own for each run, so that a search that was stopped goes on the same.
        study.sampler = optuna.samplers.TPESampler(seed=config.seed + k)
        tried = [{name: row[name] for name in space} for row in rows]
        left = [c for c in combinations if c not in tried]
        if not left:
            break
        values = study.ask(space).params
        if values not in left:  # measured once is enough
            values = left[np.random.default_rng([config.seed, k]).integers(len(left))]
        row = _measured(_varied(config, **values), data)
        rows.append({**values, **row})
        study.add_trial(known(rows[-1]))
        write(identity, rows, folder)
        progress(k + 1, runs)
    return write(identity, rows, folder)


def write(identity: str, runs: list[dict[str, Any]], folder: Path) -> dict[str, Any]:
    """Write search.json and search.csv, and return what the former holds."""
    best = min(runs, key=lambda row: float(row["validation_percent"]))
    figures = {"identity": identity, "runs": runs, "best": best}
    with replacing(folder / "search.json") as temporary:
        temporary.write_text(json.dumps(figures, indent=1) + "\n", "utf-8")
    lines = [",".join(COLUMNS), *(",".join(f"{row[c]:g}" for c in COLUMNS) for row in runs)]
    with replacing(folder / "search.csv") as temporary:
        temporary.write_text("\n".join(lines) + "\n", "utf-8")
    return figures


def _varied(config: PaperConfig, noise: float, penalty: float, trials: int) -> PaperConfig:
    phases = [Phase(**{**phase.model_dump(), "noise": noise}) for phase in config.phases]
    return config.model_copy(update={"phases": phases, "penalty": penalty, "trials": trials})


def _measured(config: PaperConfig, data: Dataset) -> dict[str, float]:
    """Return the figures of one run, on the trials it sets aside."""
    model, _ = train(config, data)
    aside = split(config, data)[1]
    figures = together([errors(model.rollout(designs_of(b)), b) for b in aside])
    return {
        "validation_percent": float(np.mean(figures.percent[:, -1])),
        "gap_mm": float(np.mean(figures.gap[:, -1])),
    }
