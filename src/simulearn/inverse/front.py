"""The answers of a search side by side: what each costs, and which of them no other beats in all.

An answer is on the front if no other is at least as good in everything and better in something:
error, probability that a print meets the goals, length of the actuators, time of the print. Where
there is one whose parts do not run through each other, those whose parts do are not on it.
"""

from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.grid import Grid, check_designs, grid_to_dict
from simulearn.inverse.checking import Check
from simulearn.inverse.probability import Probability
from simulearn.material import load_material

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Answer:
    """One of several designs that come to the goals.

    Attributes:
        check: the design, by the engine and by finite elements.
        actuators: how many beams have one.
        actuator_mm: length of them all.
        nearest: distance from the nearest other answer, as `archive` has it; None if it is alone.
        printer: by whose profile it is printed.
        print_seconds: that this takes, without heating; None where it is not known.
        probability: how often prints of it meet the goals, where the task asks anything of prints.
        on_front: whether no other answer is as good in everything and better in something, and
            parts of it do not run through each other, if there is such an answer.
    """

    check: Check
    actuators: int
    actuator_mm: float
    nearest: float | None
    printer: str = ""
    print_seconds: float | None = None
    probability: Probability | None = None
    on_front: bool = True

    @property
    def grid(self) -> Grid:
        """The design."""
        return self.check.grid

    @property
    def error(self) -> float:
        """By finite elements where they have answered, else by the engine, mm."""
        check = self.check
        return check.error_mm if check.error_fea_mm is None else check.error_fea_mm

    @property
    def share(self) -> float | None:
        """Of prints that are within all tolerances; None where that is not known."""
        return None if self.probability is None else self.probability.together

    @property
    def collides(self) -> bool:
        """Whether parts of its shape run through each other."""
        return bool(self.check.collisions)

    @property
    def costs(self) -> tuple[float, float, float, float]:
        """What of two answers the better one has less of; infinite where it is not known.

        In steps of .05 mm, a hundredth, mm and minutes: what differs by less is as good.
        """
        return (
            0.05 * round(self.error / 0.05),
            np.inf if self.share is None else 1 - round(self.share, 2),
            round(self.actuator_mm),
            np.inf if self.print_seconds is None else round(self.print_seconds / 60),
        )

    def more_robust_than(self, other: "Answer") -> bool:
        """Whether prints of it meet the goals more often, or it does not collide and other does."""
        mine, known = self.probability, other.probability
        if mine is None or self.collides > other.collides:
            return False
        return self.collides < other.collides or known is None or mine.better_than(known)

    @property
    def words(self) -> str:
        """What it takes, in a line."""
        many = "actuator" if self.actuators == 1 else "actuators"
        parts = [f"{self.actuators} {many} of {self.actuator_mm:.0f} mm in all"]
        if self.print_seconds is not None:
            parts.append(f"printed in {self.print_seconds / 60:.0f} min")
        if self.share is not None:
            parts.append(f"{100 * self.share:.0f} % of prints within tolerance")
        if self.collides:
            parts.append("parts run through each other")
        return ", ".join(parts)

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain data: lengths in mm, times in s."""
        check, prints = self.check, self.probability
        return {
            "error_mm": check.error_mm,
            "error_fea_mm": check.error_fea_mm,
            "why_no_fea": check.why if check.error_fea_mm is None else None,
            "apart_mm": check.apart_mm,
            "actuators": self.actuators,
            "actuator_mm": round(self.actuator_mm, 3),
            "printer": self.printer,
            "print_seconds": self.print_seconds and round(self.print_seconds, 1),
            "nearest": None if self.nearest is None else round(self.nearest, 4),
            "on_front": self.on_front,
            "collisions": [asdict(message) for message in check.collisions],
            **({} if prints is None else {"probability": prints.to_dict()}),
            "grid": grid_to_dict(self.grid),
        }


def actuators_of(grid: Grid) -> tuple[int, float]:
    """Return how many actuators a valid grid has, and the length (mm) of them all."""
    ratios = grid.actuators
    checks = check_designs(
        grid.beams, grid.fixed, grid.joints[None], ratios[None], load_material(grid.material)
    )
    return int(np.count_nonzero(ratios)), float(np.abs(ratios) @ checks.net_lengths[0])


def non_dominated(costs: Array) -> Mask:
    """Return which rows (N,) no other row is at least as good in everything and better in one.

    Args:
        costs: (N, K), of which less is better; infinite where one is not known.
    """
    as_good = (costs[:, None] <= costs).all(axis=-1)
    better = (costs[:, None] < costs).any(axis=-1)
    return np.asarray(~(as_good & better).any(axis=0))


def on_front(answers: Iterable[Answer]) -> tuple[Answer, ...]:
    """Return answers with the mark of those that are on the front."""
    given = tuple(answers)
    clear = np.array([not one.collides for one in given])
    clear |= not clear.any()
    front = np.zeros(len(given), bool)
    front[clear] = non_dominated(np.array([one.costs for one in given])[clear])
    return tuple(replace(one, on_front=bool(mark)) for one, mark in zip(given, front, strict=True))


def choice(errors: Array, costs: Array, distances: Array, good: float, count: int) -> list[int]:
    """Return which designs to answer with, the closest first.

    The closest, then of those that are good the one that costs least in each respect, then those
    that are farthest from all chosen before, of the ones that no other beats as long as there are.

    Args:
        errors: (N,) mm.
        costs: (N, K) other than the error.
        distances: (N, N) between the designs.
        good: error up to which a design may be chosen, mm.
        count: how many, at most.
    """
    left = [int(k) for k in np.argsort(errors, kind="stable") if errors[k] <= good]
    if not left:
        return []
    front = non_dominated(np.column_stack([errors, costs]))
    chosen = [left.pop(0)]
    for column in costs.T:
        if left and len(chosen) < count:
            least = min(left, key=column.__getitem__)
            if column[least] < column[chosen].min():
                chosen.append(least)
                left.remove(least)
    while left and len(chosen) < count:
        apart = distances[np.ix_(left, chosen)].min(axis=1)
        order = np.lexsort([-apart, ~front[left]])
        chosen.append(left.pop(int(order[0])))
    return [chosen[0], *sorted(chosen[1:], key=errors.__getitem__)]
