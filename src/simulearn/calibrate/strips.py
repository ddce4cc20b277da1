"""The readings of a form, strip by strip, as a fit needs them: means, counts and which side."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.calibrate.form import Form, StripRecord

Numbers = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Strip:
    """What was read of one kind of strip.

    Attributes:
        name: of the strip.
        record: as it stands in the form.
        readings: (R, 2) chord and rise, mm, NaN where blank.
        before: (R,) lengths before the bath, mm, NaN where blank.
        rises: whether it is measured on its top, where it is hollow, else on its bottom.
    """

    name: str
    record: StripRecord
    readings: Numbers
    before: Numbers
    rises: bool

    @property
    def counts(self) -> NDArray[np.int64]:
        """(2,) how many readings of chord and rise there are."""
        return np.isfinite(self.readings).sum(axis=0)

    @property
    def means(self) -> Numbers:
        """(2,) means of chord and rise, mm; 0 where there is none."""
        many = np.maximum(self.counts, 1)
        return np.asarray(np.nansum(self.readings, axis=0) / many)

    @property
    def known(self) -> NDArray[np.bool_]:
        """(2,) whether there is a reading."""
        return self.counts > 0


def strips_of(form: Form) -> list[Strip]:
    """Return the strips of which chord or rise is known."""
    found = []
    for name, record in form.strips.items():
        chord, rise, before = (
            np.array([np.nan if v is None else v for v in row])
            for row in (record.chord, record.rise, record.before)
        )
        readings = np.stack([chord, rise], axis=1)
        if not np.isfinite(readings).any():
            continue
        # Without a rise by its design: what is not actuated at the top hangs or bends down.
        sign = np.nansum(rise) if np.isfinite(rise).any() else sum(record.actuators) - 1e-9
        found.append(Strip(name, record, readings, before, bool(sign >= 0)))
    return found
