"""The configuration of a training run of the paper's model."""

from typing import Annotated, Literal

from pydantic import Field

from simulearn.learn.common.config import Count, Data, NotNegative, Positive, RunConfig, Share
from simulearn.learn.paper.network import Sizes


class Widths(Data):
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


class Phase(Data):
    """A part of the training.

    Attributes:
        epochs: passes over the data.
        unroll: steps that the simulator makes from a true frame on before it is judged; ten is
            all of the first stage, and then the creep engine begins from its end.
        noise: gamma, in parts of what has moved so far.
        batch: trials in each update of the weights.
    """

    epochs: Count
    unroll: Literal[1, 2, 5, 10] = 1
    noise: NotNegative = 0.1
    batch: Count = 16


class PaperConfig(RunConfig):
    """A training run of the paper's model, besides what all runs have; see `RunConfig`.

    Attributes:
        kind: of the model.
        orientation: "any": trials are turned about z by any angle, anew in every epoch;
            "aligned": the model turns designs to a common direction before it predicts them, and
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

    kind: Literal["paper"] = "paper"
    orientation: Literal["any", "aligned"] = "any"
    mirrored: bool = True
    variance: Annotated[list[Share], Field(min_length=2, max_length=2)] = Field(
        default=[0.999999, 0.98]
    )
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
