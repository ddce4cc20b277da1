"""A run in its folder: checkpoints, loss curve, and the model at the end.

FOLDER/*.safetensors           checkpoints, replaced as the run goes on
FOLDER/loss.csv, loss.png      likewise
FOLDER/model/                  the bundle, at the end
"""

from collections.abc import Callable, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from simulearn.dataset import Dataset, read_dataset
from simulearn.errors import InputError
from simulearn.files import replacing
from simulearn.learn.common.bundle import Bundle
from simulearn.learn.common.model import Model
from simulearn.learn.common.saving import copy_with, save_bundle
from simulearn.learn.common.trials import split, validate
from simulearn.learn.equilibrium import train as equilibrium
from simulearn.learn.equilibrium.config import EquilibriumConfig
from simulearn.learn.equilibrium.model import Equilibrium
from simulearn.learn.equilibrium.stages import StageRow
from simulearn.learn.paper import train as paper
from simulearn.learn.paper.config import PaperConfig

Rows = Sequence[paper.EpochRow] | Sequence[StageRow]
Draw = Callable[[Any, Path], None]
Progress = Callable[[Any, int, int], None]  # (last row or None, updates done, updates in all)


def run(
    config: PaperConfig | EquilibriumConfig,
    data: Dataset,
    folder: Path,
    progress: Progress,
    draw: Draw | None = None,
    begin: Bundle | None = None,
) -> tuple[Bundle, Rows, float]:
    """Train a model in a folder, or go on with one.

    Args:
        config: of the run.
        data: to learn from.
        folder: of the run; it exists.
        progress: called after every update and every row of the loss curve.
        draw: draws the loss curve into a file.
        begin: a model to go on from.

    Returns:
        The model, the loss curve, and the mean vertex error of the trials set aside, % of
        their dimension.

    Raises:
        InputError: the trials are too few, or the run cannot go on from that model.
    """
    first: Equilibrium | None = None
    if begin is not None:
        if not isinstance(begin.model, Equilibrium) or not isinstance(config, EquilibriumConfig):
            raise InputError("only runs and models of the kind equilibrium go on from a model")
        first = begin.model
    rows: list[Any] = []

    def report(row: Any, done: int, total: int) -> None:
        if row is not None and row not in rows:
            rows.append(row)
            write_curve(rows, folder, draw)
        progress(row, done, total)

    model: Model
    every: Rows
    more: list[Dataset] = []
    if isinstance(config, EquilibriumConfig):
        model, every = equilibrium.train(config, data, folder, report, first)
        percent = validate(model, split(config, data)[1])
        fine = () if config.fine is None else (config.fine,)
        more = [read_dataset(path, stress=False) for path in (*config.more, *fine)]
    else:
        model, every = paper.train(config, data, folder / "checkpoint.safetensors", report)
        percent = every[-1].validation_percent
    write_curve(every, folder, draw)
    training = config.model_dump(mode="json")
    if begin is not None:
        training["begin"] = {"name": begin.card.name, "weights": begin.card.weights}
    bundle = save_bundle(folder / "model", model, config.name, data, training, more=more)
    return bundle, every, percent


def new_bound(bundle: Bundle, config: EquilibriumConfig, folder: Path) -> Bundle:
    """Write a model to FOLDER/model with its error estimate fitted anew.

    Args:
        bundle: of the model.
        config: of a run; its calibration sets are what the estimate is fitted to.
        folder: of the run; it exists.

    Raises:
        InputError: there is nothing to fit to, or the model is of a kind without an estimate.
    """
    if not isinstance(bundle.model, Equilibrium):
        raise InputError(f'{bundle.path}: models of kind "{bundle.card.kind}" have no estimate')
    model = equilibrium.with_new_bound(bundle.model, config)
    calibration = {"calibration": config.model_dump(mode="json")["calibration"]}
    return copy_with(bundle, folder / "model", model, calibration)


def write_curve(rows: Rows, folder: Path, draw: Draw | None) -> None:
    """Write the loss curve."""
    names = [field.name for field in fields(rows[0])]
    lines = [",".join(names)]
    lines += [",".join(map(_text, asdict(row).values())) for row in rows]
    with replacing(folder / "loss.csv") as temporary:
        temporary.write_text("\n".join(lines) + "\n", "utf-8")
    if draw is not None:
        draw(rows, folder / "loss.png")


def _text(value: str | float) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"
