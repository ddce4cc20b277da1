"""The configuration of a training run: one commented TOML, of the kind of model it names."""

import tomllib
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from simulearn.errors import InputError
from simulearn.files import read_text
from simulearn.learn.equilibrium.config import EquilibriumConfig
from simulearn.learn.paper.config import PaperConfig

CONFIGS = Path(__file__).parent / "configs"


def shipped() -> list[str]:
    """Return the names of the configurations that come with SimuLearn."""
    return sorted(path.stem for path in CONFIGS.glob("*.toml"))


def read_config(name: Path | str) -> PaperConfig | EquilibriumConfig:
    """Read the configuration of a run: a TOML file, or the name of one that comes with SimuLearn.

    Raises:
        InputError: it is missing or wrong; the message names the key.
    """
    path = Path(name)
    if str(name) in shipped() and not path.exists():
        path = CONFIGS / f"{name}.toml"
    elif not path.suffix and not path.exists():
        raise InputError(f"{name}: is neither a file nor one of {', '.join(shipped())}")
    try:
        data = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: is not valid TOML: {error}") from error
    return config_of(data, str(path))


def config_of(data: Any, where: str) -> PaperConfig | EquilibriumConfig:
    """Return the configuration of plain data.

    Raises:
        InputError: a key is unknown, missing or wrong.
    """
    kind = data.get("kind") if isinstance(data, dict) else None
    form = EquilibriumConfig if kind in ("equilibrium", "beams") else PaperConfig
    try:
        return form.model_validate(data)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(map(str, first["loc"])) or "the file"
        raise InputError(f"{where}: {key}: {first['msg']}") from error
