"""Lines and graphs in JSON, as programs write them."""

import json

import numpy as np
import pytest
from messy import l_grid, same

from simulearn.drawings.importing import Options, grid_of, imported
from simulearn.drawings.lists import read_json_lines
from simulearn.errors import InputError

BEAMS = [line.tolist() for line in l_grid()]
PLACES = sorted({tuple(point) for line in BEAMS for point in line})
PAIRS = [[PLACES.index(tuple(a)), PLACES.index(tuple(b))] for a, b in BEAMS]


def xyz(point, names="XYZ"):
    return dict(zip(names, [*point, 0.0], strict=True))


FORMS = {
    "lists": BEAMS,
    "in space": [[[*a, 0], [*b, 0]] for a, b in BEAMS],
    "rows": [[*a, *b] for a, b in BEAMS],
    "rows in space": [[*a, 0, *b, 0] for a, b in BEAMS],
    "From and To": {"lines": [{"From": xyz(a), "To": xyz(b), "Length": 65} for a, b in BEAMS]},
    "start and end": [{"start": a, "end": xyz(b, "xyz")} for a, b in BEAMS],
    "x1 y1 x2 y2": [{"x1": a[0], "y1": a[1], "x2": b[0], "y2": b[1]} for a, b in BEAMS],
    "one end of each kind": {"lines": [[xyz(a), b] for a, b in BEAMS]},
    "by layer": {"passive": BEAMS[:4], "top 0.5": BEAMS[4:]},
    "objects with points": {"curves": [{"points": [a, b], "layer": "x"} for a, b in BEAMS]},
    "lines of a library": [
        {"dtype": "compas.geometry/Line", "data": {"start": [*a, 0], "end": [*b, 0]}}
        for a, b in BEAMS
    ],
    "text within text": {"data": json.dumps({"lines": BEAMS})},
    "tree": {
        "values": [
            {
                "ParamName": "lines",
                "InnerTree": {
                    "{0}": [
                        {
                            "type": "Rhino.Geometry.Line",
                            "data": json.dumps({"From": xyz(a), "To": xyz(b)}),
                        }
                        for a, b in BEAMS
                    ]
                },
            }
        ]
    },
    "graph, new": {
        "dtype": "compas.datastructures/Graph",
        "data": {
            "node": {str(k): xyz(p, "xyz") for k, p in enumerate(PLACES)},
            "edge": {
                str(k): {str(j): {} for i, j in PAIRS if i == k} for k in range(len(PLACES))
            },
        },
    },
    "graph, old": {
        "compas": "1.17",
        "datatype": "compas.datastructures/Network",
        "data": {
            "dna": {"x": 0.0, "y": 0.0, "z": 0.0},
            "node": {str(k): {"x": x, "y": y} for k, (x, y) in enumerate(PLACES)},
            "edge": {str(i): {str(j): {} for a, j in PAIRS if a == i} for i in range(len(PLACES))},
        },
    },
    "node-link": {
        "directed": False,
        "nodes": [{"id": f"n{k}", "x": x, "y": y} for k, (x, y) in enumerate(PLACES)],
        "links": [{"source": f"n{i}", "target": f"n{j}"} for i, j in PAIRS],
    },
    "node-link with pos": {
        "nodes": [{"id": k, "pos": list(p)} for k, p in enumerate(PLACES)],
        "edges": [{"source": i, "target": j, "key": 0} for i, j in PAIRS],
    },
    "adjacency": {
        "nodes": [{"id": k, "x": x, "y": y} for k, (x, y) in enumerate(PLACES)],
        "adjacency": [
            [{"id": b if a == k else a} for a, b in PAIRS if k in (a, b)]
            for k in range(len(PLACES))
        ],
    },
    "elements": {
        "elements": {
            "nodes": [
                {"data": {"id": str(k)}, "position": {"x": x, "y": y}}
                for k, (x, y) in enumerate(PLACES)
            ],
            "edges": [{"data": {"source": str(i), "target": str(j)}} for i, j in PAIRS],
        }
    },
    "vertices and edges": {"vertices": PLACES, "edges": PAIRS},
    "vertices and indices as floats": {
        "vertices": PLACES, "edges": [[float(i), float(j)] for i, j in PAIRS]
    },
    "vertices and faces": {
        "vertices": PLACES, "faces": [[0, 3, 4, 1], [1, 4, 5, 2], [3, 6, 7, 4]]
    },
    "GeoJSON": {
        "type": "FeatureCollection",
        "features": [
            {
                "type": "Feature",
                "properties": {"layer": "beams"},
                "geometry": {"type": "LineString", "coordinates": line},
            }
            for line in BEAMS[:5]
        ]
        + [
            {
                "type": "Feature",
                "properties": None,
                "geometry": {"type": "MultiLineString", "coordinates": BEAMS[5:]},
            }
        ],
    },
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_each_form_gives_the_grid(form):
    value = json.loads(json.dumps(FORMS[form]))
    assert same(grid_of(read_json_lines(value)).grid, BEAMS)


@pytest.mark.parametrize("key", ["units", "unit", "Units", "modelUnits"])
@pytest.mark.parametrize(("name", "mm"), [("Meters", 1000), ("inches", 25.4), ("Millimeters", 1)])
def test_the_unit_is_honoured(key, name, mm):
    value = {key: name, "lines": [(np.array(line) / mm).tolist() for line in BEAMS]}
    result = grid_of(read_json_lines(value))
    assert same(result.grid, BEAMS)
    assert name in result.unit.source


def test_numbers_as_text_are_read_and_reported():
    value = [[["0", "0"], ["65.0", "0"]], *BEAMS[1:]]
    found = read_json_lines(value)
    assert found.lines[0].points[1, 0] == 65
    assert found.messages == ['4 numbers are written as text, as in "65.0", and read as numbers']


def test_faces_are_reported():
    value = json.loads(json.dumps(FORMS["vertices and faces"]))
    assert read_json_lines(value).messages == [
        "the faces of the mesh give the lines: each side is one"
    ]


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ([], "holds no lines; looked for"),
        ({}, r"holds no lines \(1 x object\); looked for"),
        ({"name": "x"}, r"holds no lines \(1 x object\); looked for"),
        ([1, 2, 3, 4, 5], "has 5 numbers; a line has 4 or 6"),
        ([[[0, 0], [1, "x"]]], r'\[0\]\[1\]\[1\] is "x"; a coordinate is a number'),
        ([[[0, 0], [1, None]]], r"\[0\]\[1\]\[1\] is null; a coordinate is a number"),
        ([[[0, 0], [1, True]]], r"\[0\]\[1\]\[1\] is true; a coordinate is a number"),
        ([[[0, 0], [1, float("inf")]]], "a coordinate is a finite number"),
        ([[[0, 0], [1, 10**400]]], "a coordinate is a finite number"),
        ({"lines": [{"From": {"X": 0, "Y": 0}, "To": {"X": 1}}]}, "end 1 is no point"),
        ({"nodes": [[0, 0], [1, 0]], "edges": [[1, 2]]}, "names the node 2.*count from 1"),
        ({"nodes": {"a": [0, 0]}, "edges": [["a", "b"]]}, 'names the node "b", which does not'),
        ({"nodes": [{"id": 1}], "edges": [[1, 1]]}, r"nodes\[0\] has no place"),
        ({"nodes": [[0, 0]], "edges": [7]}, r"edges\[0\] is 7; an edge names two nodes"),
        ({"units": "furlongs", "lines": BEAMS}, '"furlongs" is no unit'),
        (["a"], r'\[0\] is "a" where a line would be'),
        ({"type": "Polygon", "coordinates": []}, "holds no lines"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(value, words):
    with pytest.raises(InputError, match=words):
        read_json_lines(value)


def test_nesting_without_end_is_refused():
    value = [[0, 0], [1, 1]]
    for _ in range(200):
        value = [value]
    with pytest.raises(InputError, match="nested too deeply"):
        read_json_lines(value)
    with pytest.raises(InputError, match="nested too deeply"):
        imported(b"[" * 100_000, "deep.json", Options())
