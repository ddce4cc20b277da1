"""What the configurations of all training runs have in common."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Count = Annotated[int, Field(ge=1)]
Positive = Annotated[float, Field(gt=0)]
Share = Annotated[float, Field(gt=0, lt=1)]
NotNegative = Annotated[float, Field(ge=0)]


class Data(BaseModel):
    """Plain data that is checked: no unknown keys, finite numbers."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class RunConfig(Data):
    """A training run.

    Attributes:
        name: what the model is called.
        data: the packed data set; a relative path is relative to where the command runs.
        seed: of everything random.
        trials: how many to learn from at most; 0: all.
        validation: of them, how many are set aside to watch the training by.
    """

    name: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9._-]*$")]
    data: Annotated[str, Field(min_length=1)]
    seed: Annotated[int, Field(ge=0)] = 0
    trials: Annotated[int, Field(ge=0)] = 0
    validation: Count = 32
