"""Result files: what is written is read again, and whatever else is read gives one clear line."""

import dataclasses
import json

import numpy as np
import pytest

import synthetic
from simulearn.errors import InputError, Message
from simulearn.grid import grid_to_dict, make
from simulearn.material import Identity
from simulearn.schedule import Snap
from simulearn.simulate import read_json, read_npz, result_to_dict, write_json, write_npz

RESULT = synthetic.result()
GOOD = result_to_dict(RESULT)


def test_json_has_the_agreed_keys_and_is_read_again(tmp_path):
    path = tmp_path / "a.json"
    write_json(RESULT, path)
    data = json.loads(path.read_text())
    assert list(data) == [
        *("schema", "grid", "engine", "joints", "beams", "seconds"),
        *("stable", "bound_mm", "snaps", "warnings", "material", "model", "collisions"),
    ]
    assert data["schema"] == "simulearn.result/1"
    again = read_json(path)
    np.testing.assert_allclose(again.joints, RESULT.joints, atol=1e-6)
    np.testing.assert_allclose(again.beams, RESULT.beams, atol=1e-6)
    assert grid_to_dict(again.grid) == grid_to_dict(RESULT.grid)
    assert (again.engine, again.seconds) == (RESULT.engine, RESULT.seconds)
    assert again.stress is again.solid is again.displacements is None


QUALIFIED = dataclasses.replace(
    RESULT,
    stable=False,
    bound_mm=0.25,
    snaps=(Snap(0.944, 10), Snap(1.0, 11)),
    warnings=(Message("beam-long", "beam 3", "beam 3 is 120.00 mm long"),),
    material=Identity(name="mine", digest="ab" * 32),
    model=Identity(name="tiny", digest="cd" * 32),
)
QUALITIES = ("stable", "bound_mm", "snaps", "warnings", "material", "model")


@pytest.mark.parametrize(
    ("name", "write", "read"),
    [("a.json", write_json, read_json), ("a.npz", write_npz, read_npz)],
)
def test_what_qualifies_an_answer_is_kept(tmp_path, name, write, read):
    write(QUALIFIED, tmp_path / name)
    again = read(tmp_path / name)
    for name in QUALITIES:
        assert getattr(again, name) == getattr(QUALIFIED, name), name


def test_the_machine_form_is_the_agreed_one():
    data = result_to_dict(QUALIFIED)
    assert data["snaps"] == [{"released": 0.944, "frame": 10}, {"released": 1.0, "frame": 11}]
    assert data["warnings"] == [
        {"code": "beam-long", "where": "beam 3", "message": "beam 3 is 120.00 mm long"}
    ]
    assert data["material"] == {"name": "mine", "digest": "ab" * 32}
    assert (data["stable"], data["bound_mm"]) == (False, 0.25)
    assert result_to_dict(RESULT)["model"] is result_to_dict(RESULT)["bound_mm"] is None


def test_files_of_earlier_versions_are_read(tmp_path):
    path = tmp_path / "a.json"
    path.write_text(json.dumps({k: v for k, v in GOOD.items() if k not in QUALITIES}))
    again = read_json(path)
    assert (again.stable, again.bound_mm, again.snaps, again.warnings) == (True, None, (), ())
    assert again.material == Identity(name="pla-hot-water", digest="")


@pytest.mark.parametrize("solid", [True, False])
def test_npz_keeps_everything_to_the_last_bit(tmp_path, solid):
    result = synthetic.result(solid=solid)
    path = tmp_path / "a.npz"
    write_npz(result, path)
    again = read_npz(path)
    for name in ("joints", "beams", "stress"):
        np.testing.assert_array_equal(getattr(again, name), getattr(result, name))
    assert grid_to_dict(again.grid) == grid_to_dict(result.grid)
    assert again.record == result.record
    if not solid:
        assert again.solid is again.displacements is None
        return
    np.testing.assert_array_equal(again.displacements, result.displacements)
    for field in dataclasses.fields(result.solid):
        np.testing.assert_array_equal(
            getattr(again.solid, field.name), getattr(result.solid, field.name)
        )


def test_npz_says_what_its_arrays_are(tmp_path):
    path = tmp_path / "a.npz"
    write_npz(RESULT, path)
    with np.load(path) as file:
        units = json.loads(file["units"].item())
        arrays = {name for name in file.files if file[name].ndim}
    # What only a solver reads is described by the class that holds it.
    assert {name for name in arrays if not name.startswith("solid_")} <= set(units)
    assert units["joints"].startswith("mm")


def test_a_record_may_hold_numpy_numbers(tmp_path):
    record = {"iterations": np.arange(3), "stable": np.bool_(True)}
    write_npz(dataclasses.replace(RESULT, record=record), tmp_path / "a.npz")
    assert read_npz(tmp_path / "a.npz").record == {"iterations": [0, 1, 2], "stable": True}


WRONG = {
    "not JSON": ("{", "is not valid JSON"),
    "a list": ("[]", "schema"),
    "a grid": (json.dumps(grid_to_dict(make("flat"))), '"schema": "simulearn.result/1"'),
    "no joints": (
        json.dumps({k: v for k, v in GOOD.items() if k != "joints"}),
        "joints: is missing",
    ),
    "too few frames": (json.dumps(GOOD | {"joints": GOOD["joints"][:5]}), "joints: has the shape"),
    "other grid": (
        json.dumps(GOOD | {"grid": grid_to_dict(make("flat", (1, 1)))}),
        "joints: has the shape (12, 9, 8, 3)",
    ),
    "words": (json.dumps(GOOD | {"beams": "many"}), "beams: is not an array of numbers"),
    "NaN": (json.dumps(GOOD | {"seconds": float("nan")}), "seconds: is not a number"),
    "a word for stable": (json.dumps(GOOD | {"stable": "yes"}), "stable: is not true or false"),
    "a word for a bound": (json.dumps(GOOD | {"bound_mm": "1"}), "bound_mm: is not a number"),
    "one snap": (json.dumps(GOOD | {"snaps": {"released": 1}}), "snaps: is not a list"),
    "half a snap": (json.dumps(GOOD | {"snaps": [{"released": 1}]}), "snaps: is not an object"),
    "a name for a model": (json.dumps(GOOD | {"model": "tiny"}), "model: is not an object"),
    "no engine": (json.dumps(GOOD | {"engine": None}), "engine: is not a name"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_no_result_is_refused_in_one_line(tmp_path, case):
    text, says = WRONG[case]
    path = tmp_path / "a.json"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        read_json(path)
    (line,) = str(error.value).splitlines()
    assert line.startswith(str(path))
    assert says in line


def test_corners_that_are_not_finite_are_refused(tmp_path):
    joints = RESULT.joints.copy()
    joints[3, 2, 1, 0] = np.nan
    path = tmp_path / "a.npz"
    write_npz(dataclasses.replace(RESULT, joints=joints), path)
    with pytest.raises(InputError, match="joints: holds a number that is not finite"):
        read_npz(path)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut off", b"words"])
def test_what_is_no_npz_is_refused(tmp_path, content):
    path = tmp_path / "a.npz"
    path.write_bytes(content)
    with pytest.raises(InputError, match="is not an NPZ file"):
        read_npz(path)


def test_a_missing_file_and_a_foreign_npz_are_refused(tmp_path):
    path = tmp_path / "a.npz"
    with pytest.raises(InputError, match="there is no such file"):
        read_npz(path)
    np.savez(path, x=np.arange(3))
    with pytest.raises(InputError, match="is not a result"):
        read_npz(path)
    np.savez(path, schema=np.array({"code": "runs"}, dtype=object))
    with pytest.raises(InputError, match="is not an NPZ file"):  # never unpickled
        read_npz(path)


def test_half_a_file_is_never_left(tmp_path, monkeypatch):
    path = tmp_path / "a.npz"
    write_npz(RESULT, path)
    before = path.read_bytes()

    def half(file, **arrays):
        file.write(b"PK half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez_compressed", half)
    with pytest.raises(InputError, match="No space left"):
        write_npz(RESULT, path)
    assert path.read_bytes() == before
    assert [*tmp_path.iterdir()] == [path]
