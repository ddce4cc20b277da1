"""A training run: one commented TOML with data, widths, weights of the loss and phases."""

import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from simulearn.errors import InputError
from simulearn.files import read_text
from simulearn.learn.network import Sizes

CONFIGS = Path(__file__).parent / "configs"

Count = Annotated[int, Field(ge=1)]
Positive = Annotated[float, Field(gt=0)]
Share = Annotated[float, Field(gt=0, lt=1)]
NotNegative = Annotated[float, Field(ge=0)]


class _Data(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Widths(_Data):
    """Widths of an engine's networks; see `network.Sizes`."""

    hidden: Annotated[list[Count], Field(min_length=1)]
    interaction: Annotated[list[Count], Field(min_length=2, max_length=2)]
    latent: Annotated[list[Count], Field(min_length=2, max_length=2)]
    activation: Literal["relu", "silu"] = "relu"

    @property
    def sizes(self) -> Sizes:
        """The widths as the networks take them."""
        return Sizes(
            tuple(self.hidden),
            (self.interaction[0], self.interaction[1]),
            (self.latent[0], self.latent[1]),
            self.activation,
        )


class Phase(_Data):
    """A part of the training.

    Attributes:
        epochs: passes over the data.
        unroll: steps that the simulator makes from a true frame on before it is judged; ten is
            the whole first stage, and then the creep engine begins where it has come to.
        noise: gamma, in parts of what has moved so far.
        batch: trials in each update of the weights.
    """

    epochs: Count
    unroll: Literal[1, 2, 5, 10] = 1
    noise: NotNegative = 0.1
    batch: Count = 16


class Config(_Data):
    """A training run.

    Attributes:
        name: what the model is called.
        kind: of the model.
        data: the packed data set; a relative path is relative to where the command runs.
        seed: of weights, order, turns and noise.
        trials: how many to learn from at most; 0: all.
        validation: of them, how many are set aside to watch the training by.
        orientation: "any": trials are turned about z by any angle, anew in every epoch;
            "aligned": the model turns designs to a common direction before it looks at them, and
            trials are turned by quarters only.
        mirrored: whether every other epoch sees mirror images.
        variance: the part of it that the normalisers' components hold, of geometry and of stress.
        penalty: weight of dislocation.
        stress: weight of the stresses.
        optimiser: adam, or muon, which makes updates of matrices orthogonal.
        rate: highest learning rate; it rises for `warm` of the updates and then falls as
            a cosine to `last` of itself.
        clip: largest norm of a gradient.
        release, creep: widths of the two engines.
        phases: in their order.
    """

    name: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9._-]*$")]
    kind: Literal["paper"] = "paper"
    data: Annotated[str, Field(min_length=1)]
    seed: Annotated[int, Field(ge=0)] = 0
    trials: Annotated[int, Field(ge=0)] = 0
    validation: Count = 32
    orientation: Literal["any", "aligned"] = "any"
    mirrored: bool = True
    variance: Annotated[list[Share], Field(min_length=2, max_length=2)] = [0.999999, 0.98]
    penalty: NotNegative = 1.0
    stress: NotNegative = 0.1
    optimiser: Literal["adam", "muon"] = "adam"
    rate: Positive = 1e-3
    warm: Annotated[float, Field(ge=0, lt=1)] = 0.02
    last: Annotated[float, Field(ge=0, le=1)] = 0.01
    clip: Positive = 1.0
    release: Widths
    creep: Widths
    phases: Annotated[list[Phase], Field(min_length=1)]

    @property
    def epochs(self) -> int:
        """Of all phases."""
        return sum(phase.epochs for phase in self.phases)

    def phase(self, epoch: int) -> Phase:
        """Return the phase that an epoch is in."""
        for phase in self.phases:
            if epoch < phase.epochs:
                return phase
            epoch -= phase.epochs
        raise IndexError(epoch)


class Stage(_Data):
    """A part of the fitting of a model that solves for equilibrium.

    Attributes:
        updates: of what is fitted.
        batch: pairs of trial and frame in each.
        rate: highest learning rate; it falls as a cosine.
    """

    updates: Count
    batch: Count = 32
    rate: Positive = 2e-3


class Fit(_Data):
    """The fitting of a model that solves for equilibrium, stage by stage; see `fit`.

    Attributes:
        name: what the model is called.
        kind: of the model; "beams" has no network.
        data: the packed data set; a relative path is relative to where the command runs.
        calibration: the data set that the error estimate is fitted to, or none.
        seed: of weights and order.
        trials: how many to learn from at most; 0: all.
        validation: of them, how many are set aside to watch the fitting by.
        width, message, rounds: of the network; see `local.weights`.
        law: fits the section.
        network: fits the network that corrects it.
        polish: goes on with it by the whole stiffness; see `balance`.
        stress: fits the network that tells stresses.
    """

    name: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9._-]*$")]
    kind: Literal["equilibrium", "beams"]
    data: Annotated[str, Field(min_length=1)]
    calibration: str | None = None
    seed: Annotated[int, Field(ge=0)] = 0
    trials: Annotated[int, Field(ge=0)] = 0
    validation: Count = 32
    width: Count = 64
    message: Count = 16
    rounds: Count = 2
    law: Stage
    network: Stage | None = None
    polish: Stage | None = None
    stress: Stage | None = None

    @model_validator(mode="after")
    def _network_by_kind(self) -> "Fit":
        if (self.kind == "equilibrium") != (self.network is not None):
            raise ValueError("kind equilibrium has a network, kind beams has none")
        if self.polish is not None and self.network is None:
            raise ValueError("polish goes on with a network, and there is none")
        return self


def shipped() -> list[str]:
    """Return the names of the configurations that come with SimuLearn."""
    return sorted(path.stem for path in CONFIGS.glob("*.toml"))


def read_config(name: Path | str) -> Config | Fit:
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


def config_of(data: Any, where: str) -> Config | Fit:
    """Return the configuration of plain data.

    Raises:
        InputError: a key is unknown, missing or wrong.
    """
    kind = data.get("kind") if isinstance(data, dict) else None
    form = Fit if kind in ("equilibrium", "beams") else Config
    try:
        return form.model_validate(data)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(map(str, first["loc"])) or "the file"
        raise InputError(f"{where}: {key}: {first['msg']}") from error
