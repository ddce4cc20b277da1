"""Writing a model's folder, completely or not at all; see `bundle` for what it holds."""

import hashlib
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from safetensors.numpy import save

from simulearn import __version__
from simulearn.errors import InputError
from simulearn.files import replacing
from simulearn.learn.common.bundle import Bundle, Card, Ranges, Source
from simulearn.learn.common.model import Model

if TYPE_CHECKING:
    from simulearn.dataset import Dataset


def save_bundle(
    path: Path | str,
    model: Model,
    name: str,
    data: "Dataset",
    training: Mapping[str, Any] | None = None,
    metrics: Mapping[str, Any] | None = None,
    more: "Sequence[Dataset]" = (),
) -> Bundle:
    """Write a model to a folder, completely or not at all; one that is there is replaced.

    Args:
        path: of the folder.
        model: what to write.
        name: of the model.
        data: it has learnt from; the training ranges are those of its trials to train on.
        training: the configuration of the run.
        metrics: figures of an evaluation.
        more: further sets that it has learnt from.

    Raises:
        InputError: the folder cannot be written.
    """
    from simulearn.dataset.statistics import beam_lengths

    path = _free(path)
    content = _content_of(model)
    batches = [b.take(~b.test) for b in data.batches]
    batches = [b for b in batches if len(b)]
    lengths = np.concatenate([beam_lengths(b).ravel() for b in batches])
    dimensions = np.concatenate([b.dimensions for b in batches])
    card = Card(
        name=name,
        kind=model.kind,
        commit=_commit(),
        architecture=model.config(),
        weights=hashlib.sha256(content).hexdigest(),
        material=batches[0].material,
        ranges=Ranges(dimension=_range(dimensions), beam_length=_range(lengths)),
        data=_source(data),
        more=[_source(one) for one in more],
        training=dict(training or {}),
        metrics=dict(metrics or {}),
    )
    return _write(path, content, card)


def copy_with(
    bundle: Bundle, path: Path | str, model: Model, training: Mapping[str, Any]
) -> Bundle:
    """Write a bundle to a folder with a model whose error estimate alone is another.

    Args:
        bundle: of the model as it was; figures of its estimate are left out.
        path: of the folder; a model that is there is replaced.
        model: what to write.
        training: what the configuration of the run says otherwise.

    Raises:
        InputError: the folder cannot be written.
    """
    path = _free(path)
    content = _content_of(model)
    changes = {
        "version": __version__,
        "commit": _commit(),
        "weights": hashlib.sha256(content).hexdigest(),
        "training": {**bundle.card.training, **training},
        "metrics": {},
    }
    return _write(path, content, bundle.card.model_copy(update=changes))


def _free(path: Path | str) -> Path:
    path = Path(path)
    if path.exists() and not (path / "model.json").is_file() and any(path.iterdir()):
        raise InputError(f"{path}: holds other files; name another folder for the model")
    return path


def _content_of(model: Model) -> bytes:
    return save({k: np.asarray(v, order="C") for k, v in model.to_arrays().items()})


def _write(path: Path, content: bytes, card: Card) -> Bundle:
    old: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = Path(tempfile.mkdtemp(prefix=".model-", dir=path.parent))
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error
    try:
        (temporary / "weights.safetensors").write_bytes(content)
        _write_card(temporary / "model.json", card)
        with suppress(OSError):  # some mounts know no access
            temporary.chmod(0o755)
        if path.exists():
            path.rename(old := temporary.with_name(temporary.name + "-old"))
        temporary.rename(path)
        if old is not None:
            shutil.rmtree(old)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
    return Bundle(path, card)


def _source(data: "Dataset") -> Source:
    trials = sum(int((~batch.test).sum()) for batch in data.batches)
    return Source(name=data.config.name, sha256=data.sha256, trials=trials)


def add_metrics(bundle: Bundle, name: str, figures: Mapping[str, Any]) -> Bundle:
    """Add the figures of an evaluation to a bundle's card."""
    metrics = {**bundle.card.metrics, name: dict(figures)}
    card = bundle.card.model_copy(update={"metrics": metrics})
    _write_card(bundle.path / "model.json", card)
    return Bundle(bundle.path, card)


def _write_card(path: Path, card: Card) -> None:
    with replacing(path) as temporary:
        temporary.write_text(card.model_dump_json(indent=1, by_alias=True) + "\n", "utf-8")


def _range(values: NDArray[np.floating]) -> list[float]:
    """Return least and most, rounded outwards to a tenth of a millimetre."""
    return [float(np.floor(values.min() * 10) / 10), float(np.ceil(values.max() * 10) / 10)]


def _commit() -> str | None:
    """Return the commit of the program, where it runs from a checkout."""
    try:
        done = subprocess.run(
            ["git", "rev-parse", "HEAD"],
            cwd=Path(__file__).parent,
            capture_output=True,
            text=True,
            timeout=10,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip() or None
