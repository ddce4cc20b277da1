"""Results as one binary message."""

import json
import struct

import numpy as np
import pytest

from simulearn.grid import Grid, make, validate
from simulearn.interop import frames
from simulearn.material import load_material
from simulearn.simulate import engine, summary

CODE = 8  # bytes before the header


def read(message):
    """Return the entries of a message, each with its arrays, as a reader of the format would."""
    assert message[:4] == b"SLF1"
    (size,) = struct.unpack("<I", message[4:CODE])
    assert size % 4 == 0
    header = json.loads(message[CODE : CODE + size])
    assert header["schema"] == "simulearn.frames/1"
    numbers = np.frombuffer(message, "<f4", offset=CODE + size)
    used = 0
    for entry in header["results"]:
        for name, place in entry.pop("arrays", {}).items():
            count = int(np.prod(place["shape"]))
            assert place["start"] == used
            used += count
            entry[name] = numbers[place["start"] : used].reshape(place["shape"])
    assert used == len(numbers)
    return header["results"]


@pytest.fixture(scope="module")
def learned():
    return engine("learned")


def dangling():
    """Return a valid grid with a beam and two joints that are taken off."""
    grid = make("dome", (1, 1))
    joints = [[300, 300], *grid.joints.tolist(), [130, 0]]
    beams = [*(grid.beams + 1).tolist(), [2, 5]]
    return Grid(joints, beams, [*grid.actuators, 0.0], grid.fixed + 1)


def test_arrays_are_those_of_the_results(learned):
    grids = [make("twist"), make("dome", (1, 2)), dangling()]
    outcomes = learned.simulate(grids)
    for entry, outcome in zip(read(frames.to_bytes(grids, outcomes)), outcomes, strict=True):
        assert entry["ok"] is True
        for name in ("joints", "beams"):
            assert np.abs(entry[name] - getattr(outcome, name)).max() < 1e-4
        assert {k: entry[k] for k in summary(outcome)} == json.loads(json.dumps(summary(outcome)))


def test_numbers_lead_back_to_the_design(learned):
    grid = dangling()
    (entry,) = read(frames.to_bytes([grid], learned.simulate([grid])))
    assert entry["joint_numbers"] == [1, 2, 3, 4]
    assert entry["beam_numbers"] == [0, 1, 2, 3]
    assert {warning["code"] for warning in entry["warnings"]} >= {"dangling-beam", "unused-joint"}
    flat = entry["joints"][0].mean(axis=1)[:, :2]
    given = grid.joints[entry["joint_numbers"]]
    assert np.allclose(flat - flat[0], given - given[0], atol=1e-4)


@pytest.mark.parametrize("name", ["learned", "beams", "fea"])
def test_net_lengths_are_those_of_validation(name):
    grid = make("wave", (2, 1), 43.3)
    (entry,) = read(frames.to_bytes([grid], engine(name).simulate([grid])))
    report = validate(grid, load_material(grid.material))
    expected = {str(b): round(length, 3) for b, length in report.net_lengths.items()}
    assert entry["net_lengths"] == pytest.approx(expected, abs=1.1e-3)
    assert entry["net_lengths"].keys() == expected.keys()


def test_stresses_are_equivalent_ones():
    (outcome,) = engine("fea").simulate([make("saddle", (1, 1))])
    (entry,) = read(frames.to_bytes([outcome.grid], [outcome]))
    assert entry["mises"].shape == outcome.stress.shape[:-1]
    uniaxial = np.array([7.0, 0, 0, 0, 0, 0])
    shear = np.array([0, 0, 0, 2.0, 0, 0])
    pressure = np.array([5.0, 5.0, 5.0, 0, 0, 0])
    assert np.allclose(frames.mises(np.stack([uniaxial, shear, pressure])), [7, 2 * 3**0.5, 0])


def test_failures_stand_in_their_places(learned):
    good = make("saddle", (1, 1))
    short = Grid(good.joints, good.beams, [0.01, 0, 0, 0], good.fixed)
    unknown = Grid(good.joints, good.beams, good.actuators, good.fixed, "nylon")
    nothing = Grid([], [], [], 0)
    grids = [short, good, unknown, nothing]
    entries = read(frames.to_bytes(grids, learned.simulate(grids)))
    assert [entry["ok"] for entry in entries] == [False, True, False, False]
    assert entries[0]["errors"][0]["code"] == "actuator-short"
    assert len(entries[0]["net_lengths"]) == 4
    assert entries[2]["code"] == "material-unknown"
    assert entries[2]["net_lengths"] == {}
    assert entries[3]["net_lengths"] == {}
    assert "joints" not in entries[0]
