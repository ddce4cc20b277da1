"""Grid files: what is written is read again, and whatever else is read gives one clear line."""

import json

import numpy as np
import pytest
from grids import drawn, moved
from hypothesis import example, given
from hypothesis import strategies as st

from simulearn.errors import InputError
from simulearn.grid import grid_from_dict, grid_to_dict, make, read_grid, write_grid

GOOD = grid_to_dict(make("saddle"))


def refused(data):
    with pytest.raises(InputError) as error:
        grid_from_dict(data)
    (line,) = str(error.value).splitlines()
    return line


# Round trip


@given(drawn())
def test_a_grid_is_what_its_dict_says_to_the_last_bit(grid):
    again = grid_from_dict(json.loads(json.dumps(grid_to_dict(grid))))
    for name in ("joints", "beams", "actuators"):
        np.testing.assert_array_equal(getattr(again, name), getattr(grid, name))
    assert (again.fixed, again.material) == (grid.fixed, grid.material)


def test_a_file_has_the_agreed_keys_and_is_read_again(tmp_path):
    path = tmp_path / "saddle.json"
    write_grid(make("saddle"), path)
    assert json.loads(path.read_text()) == GOOD
    assert list(GOOD) == ["schema", "joints", "beams", "actuators", "fixed", "material"]
    assert GOOD["schema"] == "simulearn.grid/1"
    assert grid_to_dict(read_grid(path)) == GOOD


def test_the_material_may_be_left_out():
    data = {key: value for key, value in GOOD.items() if key != "material"}
    assert grid_from_dict(data).material == "pla-hot-water"


def test_what_could_not_be_read_is_not_written(tmp_path):
    path = tmp_path / "grid.json"
    path.write_text("before")
    grid = make("flat")
    with pytest.raises(InputError, match=r"joints\[0\] is .*; coordinates lie within"):
        write_grid(moved(grid, joints=np.full_like(grid.joints, 1e9)), path)
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]


# Sources that are not trusted

PATHS = ["mine.toml", "/etc/x.toml", "C:mine.TOML", "a/b", "..\\b", "\\\\host\\share\\m.toml"]


@pytest.mark.parametrize("material", PATHS)
def test_a_material_is_a_path_only_for_who_allows_it(tmp_path, material):
    data = {**GOOD, "material": material}
    with pytest.raises(InputError, match="material is a path; ") as refused:
        grid_from_dict(data)
    assert (refused.value.code, refused.value.where) == ("material-path", "material")
    assert grid_from_dict(data, paths=True).material == material
    path = tmp_path / "grid.json"
    path.write_text(json.dumps(data))
    with pytest.raises(InputError, match=r"grid\.json: material is a path; "):
        read_grid(path)
    assert read_grid(path, paths=True).material == material


def test_a_file_that_is_too_large_is_not_read(tmp_path):
    path = tmp_path / "grid.json"
    path.write_text(json.dumps(GOOD) + " " * 2**24)
    with pytest.raises(InputError, match="is too large; at most 16 MiB can be read"):
        read_grid(path)


def test_a_grid_of_too_many_joints_is_refused_in_one_line():
    assert refused({**GOOD, "joints": [[0.0, 0.0]] * 20_001}) == (
        "the grid has 20001 joints; at most 20000 can be computed"
    )


def test_an_error_has_its_code_and_place():
    with pytest.raises(InputError) as error:
        grid_from_dict({**GOOD, "fixed": 9})
    assert (error.value.code, error.value.where) == ("fixed-index", "grid")


# One clear line


@pytest.mark.parametrize(
    ("key", "value", "line"),
    [
        ("schema", "simulearn.grid/2", 'schema is "simulearn.grid/2"; this program reads'),
        ("joints", [[0, 0], [1]], "joints[1] is [1]; joints are a list of [x, y]"),
        ("joints", [[0, 0], [1, "2"]], 'joints[1][1] is "2"; joints are a list of [x, y]'),
        ("joints", [[0, 0], [1, None]], "joints[1][1] is null; joints are"),
        ("joints", [[0, float("nan")]], "joints[0][1] is NaN; joints are"),
        ("joints", [[0, 0]] * 8 + [[0, 1e9]], "joints[8] is [0.0, 1000000000.0]; coordinates lie"),
        ("beams", "all", 'beams is "all"; beams are a list of [i, j]'),
        ("beams", [[0, 1, 2]], "beams[0] is [0, 1, 2]; beams are a list of [i, j]"),
        ("beams", [[0, 1.5]], "beams[0][1] is 1.5; beams are a list of [i, j], indices"),
        ("beams", [[0, -1]], "beams[0][1] is -1; beams are a list of [i, j], indices"),
        ("beams", [*GOOD["beams"][:-1], [0, 9]], "beams[11] is [0, 9]; joints are numbered 0 to 8"),
        ("beams", [*GOOD["beams"][:-1], [4, 4]], "beams[11] is [4, 4]; a beam joins two different"),
        ("beams", [*GOOD["beams"][:-1], [1, 0]], "beams[11] is [1, 0]; beam 0 joins the same two"),
        ("actuators", [0] * 11, "actuators has 11 ratios for 12 beams; there is one for each"),
        ("actuators", [0] * 7 + [1.3] + [0] * 4, "actuators[7] is 1.3; a ratio lies in [-1, 1]"),
        ("actuators", [0] * 7 + [True] + [0] * 4, "actuators[7] is true; actuators are a list"),
        ("fixed", 9, "fixed is 9; joints are numbered 0 to 8"),
        ("fixed", 4.5, "fixed is 4.5; the fixed joint is an index counted from 0"),
        ("material", 3, "material is 3; a material is the name of"),
        ("material", "a\nb", 'material is "a\\nb"; a material is the name of'),
        ("colour", "red", '"colour" is not a key of a grid; its keys are schema, joints'),
    ],
)
def test_a_wrong_value_is_named_with_its_place(key, value, line):
    assert refused({**GOOD, key: value}).startswith(line)


def test_a_point_above_the_plane_is_refused_with_what_to_do():
    assert refused({**GOOD, "joints": [[0, 0], [1, 0, 2.5]]}) == (
        "joints[1] is [1.0, 0.0, 2.5]; joints are a list of [x, y], finite numbers in mm; "
        "z is not 0: a grid is drawn flat, in the plane z = 0"
    )


def test_a_z_of_0_is_read_as_if_it_were_not_there():
    joints = [[*GOOD["joints"][0], 1e-17], *([x, y, 0] for x, y in GOOD["joints"][1:-1])]
    data = {**GOOD, "joints": [*joints, GOOD["joints"][-1]]}
    assert grid_to_dict(grid_from_dict(data)) == GOOD


def test_indices_with_a_point_are_read():
    beams = [[float(i), j] for i, j in GOOD["beams"]]
    assert grid_to_dict(grid_from_dict({**GOOD, "beams": beams, "fixed": 4.0})) == GOOD


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-be", "utf-32"])
def test_a_byte_order_mark_and_other_line_ends_are_read_over(tmp_path, encoding):
    text = "\ufeff" * (encoding == "utf-16-be") + json.dumps(GOOD, indent=1)
    (tmp_path / "grid.json").write_bytes(text.replace("\n", "\r\n").encode(encoding))
    assert grid_to_dict(read_grid(tmp_path / "grid.json")) == GOOD


@pytest.mark.parametrize(
    "content",
    [
        b"[[[0, 0, 0], [2, 0, 0]], [[2, 0, 0], [2, 2, 0]]]",
        b'{"data": {"node": {"0": {"x": 0}}, "edge": {}}}',
        b"0\r\nSECTION\r\n2\r\nHEADER\r\n",
        b"<svg/>",
        b"3D Geometry File Format \xfe\xfa\x00",
    ],
)
def test_what_is_a_drawing_and_no_grid_has_a_code_of_its_own(tmp_path, content):
    (tmp_path / "grid.json").write_bytes(content)
    with pytest.raises(InputError, match=r"grid\.json: is ") as error:
        read_grid(tmp_path / "grid.json")
    assert error.value.code == "not-a-grid"


@pytest.mark.parametrize("key", ["schema", "joints", "beams", "actuators", "fixed"])
def test_a_missing_key_is_named(key):
    assert refused({k: v for k, v in GOOD.items() if k != key}).startswith(f"{key} is missing; ")


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ('{"schema": "simulearn.grid/1",\n  joints}', "is not valid JSON at line 2, column 3: "),
        ("", "is not valid JSON at line 1, column 1: "),
        ('{"fixed": NaN}', "NaN is not a number that JSON may hold"),
        ('{"fixed": -Infinity}', "-Infinity is not a number that JSON may hold"),
        ('{"fixed": 1, "fixed": 2}', 'the key "fixed" occurs twice'),
        ("[" * 100_000, "is not valid; its lists are nested too deeply"),
        ("[1]", "is [1]; a grid is an object with the keys schema, joints, beams"),
        (json.dumps({**GOOD, "fixed": 9}), "fixed is 9; "),
        (json.dumps(GOOD).replace("65.0", "1e999", 1), "joints[0][1] is "),
        (json.dumps(GOOD).replace("65.0", "9" * 5000, 1), "holds a number with too many digits"),
    ],
)
def test_a_wrong_file_is_named_with_its_fault(tmp_path, text, line):
    path = tmp_path / "grid.json"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        read_grid(path)
    if line.startswith("joints"):
        line = "joints[0]["
    assert str(error.value).startswith(f"{path}: {line}")
    assert "\n" not in str(error.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.json: there is no such file"):
        read_grid(tmp_path / "none.json")


# Whatever comes, only InputError

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=20,
)


def survives(data):
    try:
        grid_to_dict(grid_from_dict(data))
    except InputError as error:
        line = str(error)
        assert len(line.splitlines()) == 1
        line.encode()  # a lone surrogate could not be printed


@given(JSON)
@example({"\ud800": 1})
@example(10**5000)
def test_any_json_is_a_grid_or_an_input_error(data):
    survives(data)


@given(st.sampled_from([*GOOD, "\ud800"]), JSON)
@example("fixed", 10**5000)
@example("actuators", [10**400] * 12)
@example("beams", [[2**63, 0]] * 12)
@example("material", "\ud800")
def test_a_grid_with_any_one_value_replaced_is_a_grid_or_an_input_error(key, value):
    survives({**GOOD, key: value})


@given(st.sampled_from(["joints", "beams", "actuators"]), st.integers(0, 8), JSON)
def test_a_grid_with_any_one_entry_replaced_is_a_grid_or_an_input_error(key, k, value):
    entries = list(GOOD[key])
    entries[k] = value
    survives({**GOOD, key: entries})


@given(st.text() | st.binary())
def test_any_text_is_a_grid_or_an_input_error(tmp_path_factory, text):
    path = tmp_path_factory.getbasetemp() / "fuzz.json"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError):
        read_grid(path)
