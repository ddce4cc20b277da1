"""Fitting a base material to the readings of a plate: values, intervals, what is undetermined.

Least squares of all differences over their standard deviations (see `noise`), together with what is
held likely before: numbers lie about the base's as far as materials of the family differ. So what
the readings do not tell stays where the base has it. The inverse of the Hessian is the covariance
(Gauss and Newton); intervals hold 90 %.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2, t

from simulearn.calibrate.checks import (
    SURE,
    blanks,
    check_section,
    check_values,
    signs_mended,
    without_outliers,
)
from simulearn.calibrate.form import Form
from simulearn.calibrate.model import Model
from simulearn.calibrate.noise import Noise
from simulearn.calibrate.parameters import (
    WORDS,
    base_values,
    check_base,
    material_with,
    parameters,
    with_section,
)
from simulearn.calibrate.search import Search
from simulearn.calibrate.strips import strips_of
from simulearn.errors import Cancel, InputError, Message
from simulearn.material import Material
from simulearn.material.reading import MOST_NAME

Numbers = NDArray[np.float64]
HELD = 0.9  # a number whose standard deviation the readings leave above this part is not determined
CLEAR = 0.5  # below, it is determined well
COVERED = 0.9  # of an interval
UNLIKELY = 0.01
# Other starts of a fit that comes to no good end, in standard deviations of what is known before.
STARTS = tuple({"strain": strain, "load": load} for strain in (-1.0, 1.0) for load in (-0.8, 1.2))
FAR = 3.5  # standard deviations of a strip's difference that is worth a warning
EDGE = 0.01  # of a range


@dataclass(frozen=True)
class Estimate:
    """A number of the fitted material.

    Attributes:
        name, words: of the number.
        base: of the base material.
        value: of the fitted one.
        low, high: interval of 90 %.
        determined: "well", "partly" or "not": whether the readings determine it.
    """

    name: str
    words: str
    base: float
    value: float
    low: float
    high: float
    determined: str


@dataclass(frozen=True)
class Difference:
    """Chord or rise of a strip: mean measured and simulated, mm, and their difference's sd."""

    strip: str
    key: str
    count: int
    measured: float
    before: float
    simulated: float
    sd: float

    @property
    def difference(self) -> float:
        """Measured less simulated, mm."""
        return self.measured - self.simulated


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted material and all that qualifies it.

    Attributes:
        material: the fitted one, named after its base; its file has a name of its own.
        base: the one that was fitted, with the section that was measured.
        form: what was used of it.
        estimates: the numbers.
        differences: measured and simulated; `before` there is of the base material.
        noise: how readings differ.
        size: printed over designed lengths, with its interval.
        singular: singular values of the readings' sensitivity to the numbers, both in their
            standard deviations (of a number: before the plate).
        covariance: (P, P) of the numbers.
        spread: factor on all intervals for what no material of the family explains.
        messages: warnings and notes.
        runs: prints that were simulated.
    """

    material: Material
    base: Material
    form: Form
    estimates: tuple[Estimate, ...]
    differences: tuple[Difference, ...]
    noise: Noise
    size: tuple[float, float, float]
    singular: tuple[float, ...]
    covariance: Numbers
    spread: float
    messages: tuple[Message, ...]
    runs: int


def fit(form: Form, base: Material, cancel: Cancel | None = None) -> Fit:
    """Return the material of the family that fits a form best.

    Args:
        form: filled in.
        base: the material that the plate was made with.
        cancel: token that stops it.

    Raises:
        InputError: a value is impossible, there is none, or the base has no strain or no weight.
        ComputationError: a strip of the base or the fitted material has no simulation.
        CancelledError: the token said so.
    """
    check_base(base)
    check_section(form, base.section)
    base = with_section(base, form.section.width, form.section.thickness)
    check_values(form, base.section.width)
    messages = blanks(form)
    form, mended = signs_mended(form)
    form, dropped = without_outliers(form)
    strips = strips_of(form)
    if not strips:
        raise InputError(
            "the form has no chord and no rise; fill in one strip at least", "calibration-empty"
        )
    model = Model(strips, base, parameters(base), cancel)
    search = Search(model, base_values(base))
    search.solve()
    if _misfit(search)[1] < UNLIKELY:  # perhaps the best near a start that is no good
        for moved in STARTS:
            search.solve_from(np.array([moved.get(name, 0.0) for name in WORDS]))
    search.hold((search.deviations() / search.prior)[:-1] >= HELD)
    search.solve()
    return _result(form, base, search, [*mended, *dropped, *messages])


def _singular(search: Search) -> Numbers:
    """Return the singular values of the readings' sensitivity to the numbers, in deviations."""
    rows = search.rows(search.slopes) * search.prior
    return np.asarray(np.linalg.svd(rows, compute_uv=False))


def _misfit(search: Search) -> tuple[float, float]:
    """Return how far off strips are in their standard deviations, and how likely that is."""
    misfit = search.data(search.values, search.slopes, search.at)
    singular = _singular(search)
    free = len(misfit) - float((singular**2 / (1 + singular**2)).sum())
    square = float(misfit @ misfit)
    return (float(np.sqrt(square / free)), float(chi2.sf(square, free))) if free > 0 else (1.0, 1.0)


def _result(form: Form, base: Material, search: Search, messages: list[Message]) -> Fit:
    """Return what a finished search has found."""
    spread, chance = _misfit(search)
    differences = tuple(_differences(search))
    if chance < UNLIKELY:
        far = max(differences, key=lambda one: abs(one.difference) / one.sd)
        text = (
            f"no material of the family gives all strips what was measured: they are {spread:.1f} "
            "times as far off as their repeats from one another; all intervals are so much wider; "
            f"farthest off is the {far.key} of strip {far.strip}, {far.measured:.2f} mm, simulated "
            f"{far.simulated:.2f}"
        )
        messages.append(Message("calibration-misfit", "form", text))
        messages += _turned(differences)
    else:
        spread = 1.0
    reach = float(t.ppf((1 + COVERED) / 2, search.noise.freedom))
    sds = search.deviations()
    shares = sds / search.prior
    wide = np.minimum(sds * spread, np.maximum(sds, search.prior))
    widened, widths = wide / search.prior, reach * wide
    low, high = (
        np.maximum(search.at - widths, search.low),
        np.minimum(search.at + widths, search.high),
    )
    estimates = tuple(
        Estimate(
            one.name,
            one.words,
            float(search.base[k]),
            float(search.at[k]),
            float(low[k]),
            float(high[k]),
            "not" if shares[k] >= HELD else "partly" if widened[k] > CLEAR else "well",
        )
        for k, one in enumerate(search.model.parameters)
    )
    messages += _strips_off(differences, spread)
    messages += _edges(search)
    messages += _untold(estimates)
    return Fit(
        material=material_with(base, search.at[:-1]).model_copy(
            update={"name": f"{base.name} fitted"[-MOST_NAME:]}
        ),
        base=base,
        form=form,
        estimates=estimates,
        differences=differences,
        noise=search.noise,
        size=(float(search.at[-1]), float(low[-1]), float(high[-1])),
        singular=tuple(_singular(search).tolist()),
        covariance=search.covariance()[:-1, :-1] * spread**2,
        spread=spread,
        messages=tuple(messages),
        runs=search.model.runs,
    )


def _differences(search: Search) -> Iterator[Difference]:
    """Yield what was measured and simulated of each strip."""
    for s, strip in enumerate(search.model.strips):
        simulated = search.values[s] + (search.at[-1] - 1) * search.slopes[s, :, -1]
        sds = np.sqrt(np.diag(search.covariances[s]))
        for k, key in enumerate(("chord", "rise")):
            if strip.known[k]:
                yield Difference(
                    strip.name,
                    key,
                    int(strip.counts[k]),
                    float(strip.means[k]),
                    float(search.start[s, k]),
                    float(simulated[k]),
                    float(sds[k]),
                )


def _turned(differences: tuple[Difference, ...]) -> Iterator[Message]:
    """Yield a warning for each strip that would bend as the base does with the other sign."""
    for one in differences:
        if one.key != "rise" or one.measured * one.before > 0:
            continue
        if min(abs(one.measured), abs(one.before)) > SURE:
            side = "up" if one.before > 0 else "down"
            text = (
                f"the rise of strip {one.strip} is {one.measured:+.2f} mm, while the base material "
                f"bends it {side} ({one.before:+.2f}); is its sign right? + is hollow on the side "
                "that was up"
            )
            yield Message("calibration-sign", f"strip {one.strip}", text)


def _strips_off(differences: tuple[Difference, ...], spread: float) -> Iterator[Message]:
    """Yield a warning for each strip that lies far from its simulation."""
    for one in differences:
        if abs(one.difference) > FAR * one.sd * spread:
            text = (
                f"the {one.key} of strip {one.strip} is {one.measured:.2f} mm and simulated "
                f"{one.simulated:.2f} mm; look whether it was held, labelled and measured as the "
                "others"
            )
            yield Message("calibration-strip", f"strip {one.strip}", text)


def _edges(search: Search) -> Iterator[Message]:
    """Yield a warning for each number at the edge of what the family has."""
    for k, one in enumerate(search.model.parameters):
        margin = EDGE * (one.high - one.low)
        if search.free[k] and not one.low + margin < search.at[k] < one.high - margin:
            text = (
                f"{one.name} is {search.at[k]:.3f}, at the edge of what SimuLearn knows "
                f"({one.low:g} to {one.high:.3g}); the material lies beyond, or a reading is wrong"
            )
            yield Message("calibration-edge", one.name, text)


def _untold(estimates: tuple[Estimate, ...]) -> Iterator[Message]:
    """Yield a note on the numbers that the readings do not tell."""
    names = [one.name for one in estimates if one.determined == "not"]
    if names:
        text = f"the readings do not tell {', '.join(names)}; the base material's stay"
        yield Message("calibration-untold", "form", text)
