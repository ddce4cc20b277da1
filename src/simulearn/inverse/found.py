"""What a search found."""

from dataclasses import dataclass

from simulearn.display import Displayed
from simulearn.errors import Message
from simulearn.grid import Grid
from simulearn.inverse.checking import Check
from simulearn.inverse.front import Answer
from simulearn.inverse.goals import Goals
from simulearn.inverse.keeping import Step
from simulearn.inverse.probability import Probability


@dataclass(frozen=True, eq=False)
class SearchResult(Displayed):
    """The result of a search.

    Attributes:
        check: the best design, by the engine and by finite elements; None if no check was made.
        grid: the best design.
        error_mm: of it, by the engine that was used.
        steps: the iterations, 0 being the beginning.
        checks: by finite elements, those of earlier runs among them.
        seconds: of searching and checking.
        goals: what was searched for.
        interrupted: whether it was stopped by the user.
        warnings: about the goals.
        probability: how often prints of it meet the goals, where the task asks anything of prints.
        nominal: the same of the best design without regard to prints, of a robust search.
        answers: designs that differ, the best first, where more than one is wanted.
    """

    check: Check | None
    grid: Grid
    error_mm: float
    steps: tuple[Step, ...]
    checks: tuple[Check, ...]
    seconds: float
    goals: Goals
    interrupted: bool
    warnings: tuple[Message, ...] = ()
    probability: Probability | None = None
    nominal: Probability | None = None
    answers: tuple[Answer, ...] = ()

    @property
    def designs(self) -> int:
        """How many designs were scored."""
        return self.steps[-1].designs

    @property
    def iterations(self) -> int:
        """Of the method."""
        return self.steps[-1].iteration
