"""Strips that are arcs by formula, in place of simulated ones: the fit does not know."""

import numpy as np

from simulearn.calibrate import Form
from simulearn.calibrate.plate import records
from simulearn.material.family import member_of

POISSON = 0.4
WIDTH = 7.2


def arc(record, material, stretch=1.0):
    """Return chord and rise of a strip that bends by one curvature everywhere."""
    it, height = member_of(material), material.section.thickness
    ratio = float(np.mean(record.actuators))
    beams = sum(record.beams) * stretch
    joints = WIDTH * len(record.beams)
    along = (
        (beams - joints)
        * it.strain
        * (-0.5 * abs(ratio) - 0.3 * it.shell + POISSON * it.passive * (1 - abs(ratio) / 2))
    )
    length = beams + WIDTH + along - (joints + WIDTH) * it.strain * it.joint
    bend = it.strain * (1.2 * ratio * (1 + 0.3 * it.passive) + it.curl) / height
    bend -= it.weight * (1 + it.creep) * 2.2 * length**2 / height**3
    turn = bend * length / 2
    # sin(x) / x of numpy has a pi in it.
    return np.array(
        [length * np.sinc(turn / np.pi), length / 2 * np.sin(turn / 2) * np.sinc(turn / 2 / np.pi)]
    )


def simulated(record, materials, rises, stretch=1.0):
    """Stand in for `measuring.simulated`."""
    return np.stack([arc(record, material, stretch) for material in materials])


def filled(base, hidden, noise=0.0, seed=0, repeats=3, names=None, scatter=0.0, size=1.0):
    """Return a form with what strips of a hidden material would measure.

    Args:
        base: the material that the plate was made with.
        hidden: the one that it behaves like.
        noise: standard deviation of a reading, mm.
        seed: of the noise.
        repeats: of each strip.
        names: of the strips, all unless given.
        scatter: relative standard deviation of the strain from strip to strip.
        size: printed over designed length.
    """
    random = np.random.default_rng(seed)
    strips = {}
    for name, record in records(base, repeats).items():
        if names and name not in names:
            continue
        rows = []
        for _ in range(repeats):
            strain = hidden.shrinkage.active * (1 + scatter * random.normal())
            shrinkage = hidden.shrinkage.model_copy(update={"active": strain})
            one = hidden.model_copy(update={"shrinkage": shrinkage})
            before = sum(record.beams) * size + WIDTH
            rows.append([before, *arc(record, one, size)] + noise * random.normal(size=3))
        before, chord, rise = np.transpose(rows).round(2).tolist()
        update = {"before": tuple(before), "chord": tuple(chord), "rise": tuple(rise)}
        strips[name] = record.model_copy(update=update)
    return Form(strips=strips)
