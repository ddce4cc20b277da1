"""Lines in tables and OBJ files."""

import numpy as np
import pytest
from messy import l_grid, same

from simulearn.drawings.importing import grid_of
from simulearn.drawings.objfile import read_obj
from simulearn.drawings.tables import read_csv
from simulearn.errors import InputError

BEAMS = [line.tolist() for line in l_grid()]


def rows(separator, *, comma=False, space=False, layer=None):
    found = []
    for a, b in BEAMS:
        numbers = [*a, 0, *b, 0] if space else [*a, *b]
        cells = [f"{n:.3f}".replace(".", ",") if comma else f"{n:.3f}" for n in numbers]
        found.append(separator.join([*cells, *([layer] if layer else [])]))
    return "\n".join(found) + "\n"


POLYLINES = [(k, *p) for k, line in enumerate(BEAMS) for p in line]

TABLES = {
    "commas": rows(","),
    "commas and blanks": rows(", "),
    "semicolons": rows(";"),
    "semicolons, decimal commas": rows(";", comma=True),
    "tabs, decimal commas": rows("\t", comma=True),
    "blanks": rows("  "),
    "in space": rows(",", space=True),
    "comments": "# beams\n\n" + rows(","),
    "header": "x1,y1,x2,y2\n" + rows(","),
    "header in space": "X1;Y1;Z1;X2;Y2;Z2\n" + rows(";", space=True),
    "header with a unit": "x1 [mm],y1 [mm],x2 [mm],y2 [mm]\n" + rows(","),
    "header by ends": "start_x,start_y,end_x,end_y,layer\n" + rows(",", layer="beams"),
    "layer without a header": rows(",", layer="beams"),
    "polylines": "id,x,y\n" + "".join(f"{k},{x},{y}\n" for k, x, y in POLYLINES),
    "polylines without a header": "".join(f"{k},{x},{y}\n" for k, x, y in POLYLINES),
    "polylines by name": "".join(f"line{k};{x};{y}\n" for k, x, y in POLYLINES),
    "polylines in space": "name,x,y,z\n" + "".join(f"b{k},{x},{y},0\n" for k, x, y in POLYLINES),
    "polylines by empty rows": "\n\n".join(
        "\n".join(f"{x} {y}" for x, y in line) for line in BEAMS
    ),
    "quoted": "\n".join(",".join(f'"{n}"' for n in (*a, *b)) for a, b in BEAMS),
    "separators at the ends": "\n".join(f"{a[0]};{a[1]};{b[0]};{b[1]};" for a, b in BEAMS),
}


@pytest.mark.parametrize("kind", TABLES)
def test_each_table_gives_the_grid(kind):
    assert same(grid_of(read_csv(TABLES[kind])).grid, BEAMS)


def test_the_unit_in_a_header_is_taken():
    inches = "".join(",".join(f"{n / 25.4:.6f}" for n in (*a, *b)) + "\n" for a, b in BEAMS)
    found = read_csv("x1 (in),y1 (in),x2 (in),y2 (in)\n" + inches)
    assert found.unit.name == "in"
    assert not found.plain
    assert same(grid_of(found).grid, BEAMS)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x1,y1,x2,y2\n0,0,65,abc\n", 'row 2, column 4 is "abc"; a coordinate is a number'),
        ("0,0,65,0\n0,0,nan,65\n", 'row 2, column 3 is "nan"; a coordinate is a finite number'),
        ("0,0,65,0\n0,0,65\n", "row 2 has 3 cells; column 4 is missing"),
        ("1,2,3,4,5\n1,2,3,4,5\n", "row 1 has 5 numbers; a line is x1, y1, x2, y2"),
        ("\n\n", "holds no rows"),
        ("a,x,y\n1,0,0\n2,5,5\n2,9,9\n", "row 2 is a line of one point"),
    ],
)
def test_what_is_wrong_in_a_table_is_named(text, words):
    text = text.replace("a,x,y", "id,x,y")
    with pytest.raises(InputError, match=words):
        read_csv(text)


def obj(relative=False):
    lines = ["# axes", "o grid"]
    for k, (a, b) in enumerate(BEAMS):
        lines += [f"v {a[0]} {a[1]} 0", f"v {b[0]} {b[1]} 0 1.0"]
        lines += ["usemtl top 0.5" if k == 0 else "usemtl passive"]
        lines += ["l -2 -1" if relative else f"l {2 * k + 1}/1 {2 * k + 2}/2"]
    return "\n".join(lines)


@pytest.mark.parametrize("relative", [False, True])
def test_obj_lines(relative):
    result = grid_of(read_obj(obj(relative)))
    assert same(result.grid, BEAMS)
    assert result.grid.actuators.tolist() == [0.5, *[0] * 9]
    assert [layer.name for layer in result.layers] == ["grid::top 0.5", "grid::passive"]


def test_obj_polylines_and_what_is_left_out():
    text = "v 0 0 0\nv 60 0 0\nv 60 60 0\nv 0 60 0\nl 1 2 3 \\\n4 1\nf 1 2 3 4\nf 1 2 3\np 1\n"
    found = read_obj(text)
    assert np.shape(found.lines[0].points) == (5, 3)
    assert {(left.kind, left.count) for left in found.left_out} == {("face", 2), ("point", 1)}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("v 0 0 0\nl 1 2\n", "line 2 names the vertex 2; vertices are numbered 1 to 1"),
        ("v 0 0 0\nl -2 1\n", "line 2 names the vertex -2"),
        ("v 0 0 0\nl 0 1\n", "line 2 names the vertex 0"),
        ("v 0 zero 0\n", "a vertex has the numbers x, y and z"),
        ("v 0 inf 0\n", "not a finite number"),
        ("v 0 0 0\nl a b\n", '"a" is no number of a vertex'),
        ("v 0 0 0\nl 1\n", "l names fewer than two vertices"),
    ],
)
def test_what_is_wrong_in_an_obj_file_is_named(text, words):
    with pytest.raises(InputError, match=words):
        read_obj(text)
