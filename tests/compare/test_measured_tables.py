"""Tables of joints and clouds as people and programs write them, and what is wrong with some."""

import numpy as np
import pytest

from simulearn.compare import JointPlaces, Scan, read_measurement
from simulearn.compare.tables import read_table
from simulearn.compare.unit import in_millimetres
from simulearn.errors import InputError

PLACES = [[1.5, 2.25, -3.0], [40.0, 0.5, 1.0], [0.0, 41.5, 7.125], [39.0, 40.0, 9.5]]


def rows(separator, point=".", names=True):
    lines = []
    for j, place in enumerate(PLACES):
        cells = [f"{x}".replace(".", point) for x in place]
        lines.append(separator.join([str(j), *cells] if names else cells))
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    "text",
    [
        rows(","),
        "joint,x,y,z\n" + rows(","),
        "Joint;X;Y;Z\r\n" + rows(";", ",").replace("\n", "\r\n"),
        "# touched on Monday\njoint\tx [mm]\ty [mm]\tz [mm]\n" + rows("\t", ","),
        rows(" ").replace("1.5", "1.5", 1),
        "joint,x,y,z,remark\n" + rows(",").replace("\n", ",well\n") + "9,,,\n",
        "z,y,x,no\n" + "\n".join(f"{z},{y},{x},J{j}" for j, (x, y, z) in enumerate(PLACES)),
        "sep=;\nMeasured on Monday\njoint;x;y;z\n" + rows(";", ","),
        "joint,x,y,z\n,mm,mm,mm\n" + rows(","),
        "joint,X/mm,Y in mm,z_mm\n" + rows(","),
        "Point no.,X-coordinate,Y coord.,pos z\n" + "P" + rows(",").replace("\n", "\nP")[:-1],
        "joint,x,y,z,simulated_x,simulated_y,simulated_z\n" + rows(",").replace("\n", ",7,8,9\n"),
        "joint,x,y,z\n"
        + rows('","', ",")
        .replace("\n", '"\n')
        .replace('","', ',"', 1)
        .replace("\n1", '\n"1')
        .replace("\n2", '\n"2')
        .replace("\n3", '\n"3'),
        "joint,x,y,z\n" + rows(",").replace("-", "\u2212") + "8,-,-,-\n9,nan,nan,nan\n",
    ],
)
def test_tables_of_joints_are_read_however_they_are_written(text):
    table = read_table(text)
    assert table.places == pytest.approx(np.array(PLACES))
    assert table.numbers.tolist() == [0, 1, 2, 3]
    assert {m.code for m in table.messages} <= {"measurement-empty"}


@pytest.mark.parametrize("name", ["Gelenk", "n\u0153ud", "\u5173\u8282", ""])
def test_a_column_of_different_whole_numbers_is_that_of_the_joints(name):
    table = read_table(f"{name},x,y,z\n" + rows(","))
    assert table.numbers.tolist() == [0, 1, 2, 3]
    assert f'column 1 ("{name}")' in table.messages[0].message
    alike = read_table(f"{name},x,y,z\n" + rows(",").replace("\n1,", "\n0,"))
    assert alike.numbers is None


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "cp1252"])
def test_tables_are_read_in_the_encodings_of_spreadsheets(tmp_path, encoding):
    path = tmp_path / "joints.csv"
    path.write_bytes(("joint;x;y;z;Gr\u00f6\u00dfe\r\n" + rows(";", ",")).encode(encoding))
    assert read_measurement(path, 9).places == pytest.approx(np.array(PLACES))


def test_clouds_may_have_numbers_intensities_and_a_count_above(tmp_path):
    many = np.random.default_rng(0).normal(size=(300, 3)).round(4)
    path = tmp_path / "points.pts"
    texts = (
        "300\n" + "".join(f"{x} {y} {z}\n" for x, y, z in many),
        "".join(f"{x} {y} {z} 0.5\n" for x, y, z in many),
        "id,x,y,z\n" + "".join(f"{k},{x},{y},{z}\n" for k, (x, y, z) in enumerate(many)),
    )
    for text in texts:
        path.write_text(text)
        cloud = read_measurement(path, 9)
        assert isinstance(cloud, Scan)
        assert cloud.points == pytest.approx(many)


def test_a_byte_order_mark_comments_and_joints_without_a_place(tmp_path):
    path = tmp_path / "joints.csv"
    path.write_bytes("\ufeffjoint;x;y;z\n3;1,5;2;3 # the corner\n\n5;;;\n0;4;5;6\n".encode())
    found = read_measurement(path, 9)
    assert found.numbers.tolist() == [3, 0]
    assert found.places.tolist() == [[1.5, 2, 3], [4, 5, 6]]
    assert [m.code for m in found.messages] == ["measurement-empty"]
    assert "passed over: 5" in found.messages[0].message


def test_points_without_numbers_are_joints_or_a_cloud(tmp_path):
    path = tmp_path / "points.xyz"
    path.write_text(rows(" ", names=False))
    few = read_measurement(path, 4)
    assert isinstance(few, JointPlaces)
    assert few.numbers is None
    many = np.random.default_rng(0).normal(size=(30_000, 3))
    np.savetxt(path, many, fmt="%.5f")
    cloud = read_measurement(path, 4)
    assert isinstance(cloud, Scan)
    assert cloud.points == pytest.approx(many, abs=1e-5)
    path.write_text(rows(" ", names=False))
    with pytest.raises(InputError, match="has 4 points without the number"):
        read_measurement(path, 3)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "holds no rows"),
        ("joint,x,y,z\n", "holds a header and no rows"),
        ("joint,x,y\n0,1,2\n", "names no column z"),
        ("0,1,2,3\n1,nan,2,3\n", 'row 2, column 2 is "nan"; a coordinate is a finite number'),
        ("0,1,2,3\n1,a,2,3\n", 'row 2, column 2 is "a"; a coordinate is a number'),
        ("0,1,2,3\n0,1,2,4\n", "row 2: joint 0 has a row already"),
        ("joint,x,y,z\nleft,1,2,3\n", 'row 2 names the joint "left"'),
        ("0.5,1,2,3\n", 'row 1 names the joint "0.5"'),
        ("0,1\n1,2\n", "row 1 has 2 cells"),
        ("joint,x,y,z\n0,,,\n", "holds no joint with a place"),
        ("x,y,z [parsec]\n1,2,3\n", "is no unit of length"),
        ("joint,x [mm],y [mm],z [cm]\n0,1,2,3\n", "row 1 names different units"),
        ("x_start,y,z,x_end\n1,2,3,4\n", "row 1 names 2 columns x"),
        ("0,1,2\n1,2,3\n2,3,4\n3,4,5\n", "joints with x and y, and no z"),
        ("-1,1,2,3\n", 'row 1 names the joint "-1"'),
    ],
)
def test_what_is_wrong_with_a_table_is_said_with_its_row(text, words):
    with pytest.raises(InputError, match=words.replace("[", r"\[")):
        read_table(text)


def test_a_long_table_names_the_row_that_is_no_number(tmp_path):
    path = tmp_path / "cloud.csv"
    lines = ["x;y;z"] + ["1,5;2;3"] * 30_000
    lines[20_001] = "nan;2;3"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(InputError, match="row 20002 has a coordinate that is no finite number"):
        read_measurement(path, 9)
    lines[20_001] = "left;2;3"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(InputError, match="a row is not as the others"):
        read_measurement(path, 9)


@pytest.mark.parametrize(
    ("times", "unit", "mm"), [(1.0, None, 1), (1e-3, "m", 1000), (1 / 25.4, "in", 25.4)]
)
def test_units_are_guessed_by_size_and_said(times, unit, mm):
    points = JointPlaces(np.array(PLACES) * times)
    scaled, messages = in_millimetres(points, 60.0)
    assert scaled.places == pytest.approx(np.array(PLACES))
    assert bool(messages) == (unit is not None)
    if unit:
        assert f'"{unit}"' in messages[0].message
    given, none = in_millimetres(points, 1e6, unit or "mm")
    assert given.places == pytest.approx(points.places * mm)
    assert none == []


def test_a_header_says_the_unit_and_odd_sizes_are_refused():
    table = read_table("joint,x (cm),y (cm),z (cm)\n" + rows(","))
    assert in_millimetres(table, 60.0)[0].places == pytest.approx(10 * np.array(PLACES))
    with pytest.raises(InputError, match="no unit makes sense"):
        in_millimetres(JointPlaces(np.array(PLACES) * 1e4), 60.0)
    slip = np.array([*PLACES, [4000.0, 0, 0]])
    with pytest.raises(InputError, match=r"without joint 7 at \(4000, 0, 0\) it is 58.* mm"):
        in_millimetres(JointPlaces(slip, np.array([0, 1, 2, 3, 7])), 60.0)


def test_files_that_are_no_measurement(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        read_measurement(tmp_path / "none.csv", 9)
    with pytest.raises(InputError, match="there is no such file"):
        read_measurement(tmp_path / "none.stl", 9)
    (tmp_path / "binary.csv").write_bytes(b"\0\1\2" * 99)
    with pytest.raises(InputError, match="is no text"):
        read_measurement(tmp_path / "binary.csv", 9)
    with pytest.raises(InputError, match="the ending is not one of"):
        read_measurement(tmp_path / "grid.dwg", 9)
