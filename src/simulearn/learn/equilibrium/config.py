"""The configuration of a training run of a model that solves for equilibrium."""

from typing import Literal

from pydantic import model_validator

from simulearn.learn.common.config import Count, Data, Positive, RunConfig

OWN_ASIDE = 5  # one of so many trials of a set of one's own is set aside


class Stage(Data):
    """A part of the fitting of a model that solves for equilibrium.

    Attributes:
        updates: of what is fitted.
        batch: pairs of trial and frame in each.
        rate: highest learning rate; it falls as a cosine.
        optimiser: adam, or muon, which makes updates of matrices orthogonal.
    """

    updates: Count
    batch: Count = 32
    rate: Positive = 2e-3
    optimiser: Literal["adam", "muon"] = "adam"


class EquilibriumConfig(RunConfig):
    """A training run of a model that solves for equilibrium, stage by stage.

    Besides what all runs have; see `RunConfig`.

    Attributes:
        kind: of the model; "beams" has no network.
        calibration: the data set that the error estimate is fitted to; where there is none, that
            are the trials set aside.
        unfamiliar: a further one for it, of kinds of grids that the model does not learn, or none.
        more: further data sets to learn from, all by the same mesh as `data`.
        fine: a further data set to learn from, by the fine mesh, or none.
        fine_share: how many times as often its trials are drawn as others.
        width, message, rounds: of the network; see `parameters.network_shapes`.
        law: fits the section.
        network: fits the network that corrects it.
        polish: goes on with it by the full tangent; see `first_order`.
        stress: fits the network that predicts stresses.
    """

    kind: Literal["equilibrium", "beams"]
    calibration: str | None = None
    unfamiliar: str | None = None
    more: tuple[str, ...] = ()
    fine: str | None = None
    fine_share: Positive = 3.0
    width: Count = 64
    message: Count = 16
    rounds: Count = 2
    law: Stage
    network: Stage | None = None
    polish: Stage | None = None
    stress: Stage | None = None

    def of_own(self, data: str, trials: int) -> "EquilibriumConfig":
        """Return the run that learns from one data set alone, of so many trials to learn from."""
        return self.model_copy(
            update={
                "data": data,
                "validation": max(1, min(self.validation, trials // OWN_ASIDE)),
                "more": (),
                "fine": None,
                "calibration": None,
                "unfamiliar": None,
            }
        )

    @model_validator(mode="after")
    def _network_by_kind(self) -> "EquilibriumConfig":
        if (self.kind == "equilibrium") != (self.network is not None):
            raise ValueError("kind equilibrium has a network, kind beams has none")
        if self.polish is not None and self.network is None:
            raise ValueError("polish goes on with a network, and there is none")
        return self
