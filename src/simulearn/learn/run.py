"""A run in its folder: checkpoint, loss curve, and the model at the end.

FOLDER/checkpoint.safetensors  replaced after every epoch
FOLDER/loss.csv, loss.png      replaced after every epoch
FOLDER/model/                  the bundle, at the end
"""

from collections.abc import Callable, Sequence
from dataclasses import asdict, fields
from pathlib import Path

from simulearn.dataset import Dataset
from simulearn.files import replacing
from simulearn.learn.bundle import Bundle, save_bundle
from simulearn.learn.config import Config
from simulearn.learn.train import Progress, Row, train

Draw = Callable[[Sequence[Row], Path], None]


def run(
    config: Config, data: Dataset, folder: Path, progress: Progress, draw: Draw | None = None
) -> tuple[Bundle, list[Row]]:
    """Train a model in a folder, or go on with one.

    Args:
        config: of the run.
        data: to learn from.
        folder: of the run; it exists.
        progress: see `train.train`.
        draw: draws the loss curve into a file.
    """
    rows: list[Row] = []

    def tell(row: Row | None, done: int, total: int) -> None:
        if row is not None and row.epoch > len(rows):
            rows.append(row)
            write_curve(rows, folder, draw)
        progress(row, done, total)

    model, every = train(config, data, folder / "checkpoint.safetensors", tell)
    write_curve(every, folder, draw)
    bundle = save_bundle(folder / "model", model, config.name, data, config.model_dump(mode="json"))
    return bundle, every


def write_curve(rows: Sequence[Row], folder: Path, draw: Draw | None) -> None:
    """Write the loss curve."""
    names = [field.name for field in fields(Row)]
    lines = [",".join(names)]
    lines += [",".join(f"{value:.6g}" for value in asdict(row).values()) for row in rows]
    with replacing(folder / "loss.csv") as temporary:
        temporary.write_text("\n".join(lines) + "\n", "utf-8")
    if draw is not None:
        draw(rows, folder / "loss.png")
