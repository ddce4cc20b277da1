"""Time and filament: against closed forms, against stepping through a print, and the oracle."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simulearn.fabricate import extrusion, load_printer, prepare
from simulearn.fabricate.estimate import _corners, _times, durations_of
from simulearn.fabricate.moves import PRINT
from simulearn.fabricate.settings import settings_of
from simulearn.fabricate.short_strokes import mean_speeds
from simulearn.grid import make
from simulearn.material import load_material

SMALL = make("twist", (1, 1), 50.0)


def time_of(length, fastest, acceleration, corner=None):
    n = len(length)
    fastest, acceleration, corner = (
        np.broadcast_to(np.array(x, float), n).copy()
        for x in (fastest, acceleration, 0.0 if corner is None else corner)
    )
    return _times(np.array(length, float), fastest, acceleration, corner)


def test_forty_millimetres_of_bead():
    assert extrusion(40.0, 0.4, 0.2, 1.75) == pytest.approx(1.3304, abs=5e-5)
    assert extrusion(40.0, 0.4, 0.2, 1.75) == pytest.approx(40 * 0.4 * 0.2 / (pi * 1.75**2 / 4))


def test_a_long_move_is_a_trapezoid_and_a_short_one_a_triangle():
    assert time_of([100.0], 50, 1000).sum() == pytest.approx(100 / 50 + 50 / 1000)
    assert time_of([1.0], 50, 1000).sum() == pytest.approx(2 * (1.0 / 1000) ** 0.5)


def test_a_move_in_pieces_takes_as_long_as_in_one():
    pieces = [3.0, 0.2, 40.0, 6.8, 50.0]
    assert time_of(pieces, 50, 1000, [0, 1e9, 1e9, 1e9, 1e9]).sum() == pytest.approx(2.05)


def test_a_corner_costs_what_its_speed_says():
    v, a, c, d = 50.0, 1000.0, 8.0, 30.0
    length = d - v**2 / (2 * a) - (v**2 - c**2) / (2 * a)
    once = v / a + (v - c) / a + length / v
    assert time_of([d, d], v, a, [0, c]).sum() == pytest.approx(2 * once)


@pytest.mark.parametrize(("angle", "share"), [(90, 1.0), (180, 0.0), (60, 1.636), (120, 0.644)])
def test_corner_speed(angle, share):
    turn = np.radians(angle)
    steps = np.array([[1.0, 0, 0], [np.cos(turn), np.sin(turn), 0]])
    speed = _corners(steps, np.ones(2), np.ones(2, dtype=bool), 8.0)
    # r = d s / (1 - s) with s the sine of half the angle between the moves; 1 at a right angle.
    s = np.cos(turn / 2)
    assert speed[1] / 8 == pytest.approx((2**0.5 - 1) ** 0.5 * (s / (1 - s)) ** 0.5, abs=1e-6)
    assert speed[1] / 8 == pytest.approx(share, abs=0.001)


@given(st.integers(0, 10**6))
def test_two_sweeps_in_one_go_are_two_sweeps(seed):
    random = np.random.default_rng(seed)
    n = 30
    length, fastest = random.uniform(0.01, 8, n), random.uniform(5, 90, n)
    acceleration, corner = random.uniform(100, 3000, n), random.uniform(0, 40, n)
    # One corner after the other, as firmware does it.
    limit = np.append(np.minimum(corner, np.minimum(fastest, np.append(0, fastest[:-1]))), 0.0)
    speed = limit.copy()
    for k in range(n):
        speed[k + 1] = min(speed[k + 1], (speed[k] ** 2 + 2 * acceleration[k] * length[k]) ** 0.5)
    for k in reversed(range(n)):
        speed[k] = min(speed[k], (speed[k + 1] ** 2 + 2 * acceleration[k] * length[k]) ** 0.5)
    total = 0.0
    for k in range(n):
        a, b, v = speed[k], speed[k + 1], fastest[k]
        top = min(v, ((2 * acceleration[k] * length[k] + a**2 + b**2) / 2) ** 0.5)
        total += (2 * top - a - b) / acceleration[k]
        total += (length[k] - (2 * top**2 - a**2 - b**2) / (2 * acceleration[k])) / top
    assert _times(length, fastest, acceleration, corner).sum() == pytest.approx(total, rel=1e-6)


def test_time_is_more_than_distance_over_speed_and_tends_to_it():
    printer = load_printer("modix-big60")
    job = prepare([make("dome")], printer)
    moves = job.moves
    steps = np.diff(moves.places, axis=0, prepend=moves.start[None])
    length = np.linalg.norm(steps, axis=1)
    bare = float((np.where(length > 0, length, np.abs(moves.filament)) / (moves.speeds / 60)).sum())
    motion = {"acceleration_z": 1e6, "acceleration_e": 1e6}
    stiff = printer.model_copy(update={"motion": printer.motion.model_copy(update=motion)})
    settings = replace(job.settings, acceleration=1e6, acceleration_travel=1e6, corner_speed=1000.0)
    assert durations_of(moves, settings, stiff).sum() == pytest.approx(bare, rel=2e-3)
    assert job.estimate.seconds > 1.05 * bare


@pytest.mark.parametrize(
    ("name", "acceleration", "corner_speed"),
    [("ender-3", 500.0, 8.0), ("stacker-s4", 1000.0, 8.0), ("voron", 1000.0, 5.0)],
)
def test_a_print_accelerates_as_the_material_asks_or_as_the_machine_can(
    name, acceleration, corner_speed
):
    printer = load_printer(name)
    settings, _ = settings_of(load_material("pla-hot-water"), printer)
    assert (settings.acceleration, settings.corner_speed) == (acceleration, corner_speed)
    travel = acceleration if name == "voron" else printer.motion.acceleration_travel
    assert settings.acceleration_travel == travel  # Klipper has one for both


def test_a_printer_that_is_set_no_limits_prints_with_its_own_and_that_is_warned_about():
    printer = load_printer("bambu-x1")
    code = printer.code.model_copy(update={"limits": False})
    job = prepare([SMALL], printer.model_copy(update={"code": code}))
    assert job.settings.acceleration == printer.motion.acceleration == 5000.0
    (message,) = (w.message for w in job.warnings if w.code == "short-strokes")
    assert "acceleration 5000 instead of 1000" in message


def test_a_profile_that_changes_the_acceleration_is_warned_about():
    printer = load_printer("voron").model_copy(update={"print": {"acceleration": 2000.0}})
    settings, warnings = settings_of(load_material("pla-hot-water"), printer)
    assert settings.acceleration == 2000.0
    assert any("acceleration 2000 mm/s2 instead of 1000" in m.message for m in warnings)


def test_filament_in_three_units_and_heating_apart():
    job = prepare([make("dome")], load_printer("voron"))
    needs = job.estimate
    volume = sum(layer.volume for layer in job.path.layers) / 1000
    assert needs.filament_cm3 == pytest.approx(volume, rel=1e-4)
    assert needs.filament_g == pytest.approx(1.25 * needs.filament_cm3, rel=1e-9)
    assert needs.filament_mm == pytest.approx(1000 * needs.filament_cm3 / (pi * 1.75**2 / 4))
    assert needs.heating_seconds == pytest.approx((205 - 20) / 2.0)
    assert needs.seconds == pytest.approx(job.durations.sum())


@pytest.mark.parametrize(
    ("name", "warned"),
    [("stacker-s4", False), ("bambu-x1", False), ("voron", False), ("ender-3", True)],
)
def test_a_machine_that_lays_short_strokes_slower_than_the_calibration_says_so(name, warned):
    job = prepare([SMALL], load_printer(name))
    messages = [w.message for w in job.warnings if w.code == "short-strokes"]
    assert len(messages) == warned
    if warned:
        assert "at 27.8 mm/s on average; the curl was calibrated with 34.4 mm/s" in messages[0]
        assert "acceleration 500 instead of 1000" in messages[0]


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"acceleration": 3000.0}, "acceleration 3000 instead of 1000"),
        ({"speed_fill": 1800.0}, "speed 1800 instead of 3000"),
        ({"corner_speed": 0.5}, "corner speed 0.5 instead of 8"),
    ],
)
def test_settings_that_change_the_speed_of_short_strokes_are_warned_about(settings, reason):
    printer = load_printer("voron")
    motion = printer.motion.model_copy(update={"corner_speed": 8.0})
    printer = printer.model_copy(update={"print": printer.print | settings, "motion": motion})
    (message,) = (
        w.message for w in prepare([SMALL], printer).warnings if w.code == "short-strokes"
    )
    assert reason in message


def test_the_mean_speed_of_short_strokes_is_length_over_time():
    job = prepare([SMALL], load_printer("ender-3"))
    here, calibrated = mean_speeds(job.path, job.moves, job.settings, job.printer, job.material)
    beads = [bead for layer in job.path.layers for bead in layer.beads]
    layer = np.repeat(np.arange(16), [len(q.beads) for q in job.path.layers])
    length = seconds = 0.0
    for k, bead in enumerate(beads):
        if layer[k] and bead.role in ("passive", "joint"):
            moves = (job.moves.bead == k) & (job.moves.kind == PRINT)
            length += bead.lengths.sum()
            seconds += job.durations[moves].sum()
    assert here == pytest.approx(length / seconds, rel=1e-6)
    assert here < calibrated < 50.0
