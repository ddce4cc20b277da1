"""The kind of a file is known by its contents; what cannot be read is named."""

import gzip
import json

import numpy as np
import pytest
from messy import l_grid, same

from simulearn.drawings.importing import imported
from simulearn.drawings.reading import MOST_BYTES, own_grid, read_drawing
from simulearn.errors import InputError
from simulearn.grid import grid_to_dict, make

BEAMS = [line.tolist() for line in l_grid()]
JSON = json.dumps(BEAMS)
CSV = "".join(",".join(map(str, (*a, *b))) + "\r\n" for a, b in BEAMS)
OBJ = "".join(f"v {a[0]} {a[1]} 0\nv {b[0]} {b[1]} 0\nl -1 -2\n" for a, b in BEAMS)


@pytest.mark.parametrize("text", [JSON, CSV, OBJ], ids=["JSON", "CSV", "OBJ"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_the_encoding_does_not_matter_nor_does_the_name(text, encoding):
    assert same(imported(text.encode(encoding), "beams.dxf").grid, BEAMS)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "is empty"),
        (b"\0\0\0\0\n", "is empty"),
        (b"AC1032\0\0\0", "is a DWG file; save it as DXF"),
        (b"%PDF-1.5\n", "is a PDF or Illustrator file; save it as SVG or DXF"),
        (b"%!PS-Adobe-3.0 EPSF\n", "is a PostScript file"),
        (b"ISO-10303-21;\nHEADER;", "is a STEP file"),
        (b"solid cube\n facet normal", "is an STL mesh"),
        (b"x" * 80 + b"\2\0\0\0" + b"\0" * 100, "is an STL mesh"),
        (b"ply\nformat ascii 1.0\n", "is a PLY mesh"),
        (b"glTF\2\0\0\0", "is a glTF model"),
        (b"\x89PNG\r\n\x1a\n", "is a picture"),
        (b"\xff\xd8\xff\xe0", "is a picture"),
        (b"PK\3\4....", "is a ZIP archive"),
        (b"\x89HDF\r\n", "is an HDF5 file"),
        (b"<?xml version='1.0'?><Archive name='x'/>", "is XML with <Archive> but no <svg>"),
        (b"hello world", "is of no kind that is read"),
        (b"\x01\x02\x00\x03\x04", "is neither a drawing nor text"),
        (b"[[[0,0],[1,", "is not valid JSON"),
        (b"[[[0,0],[1,NaN]]]", "NaN is not a number"),
        (b"\x1f\x8bnot gzip at all", "is a damaged gzip file"),
    ],
)
def test_what_cannot_be_read_is_named(data, words):
    with pytest.raises(InputError, match=words):
        imported(data, "file.x")


def test_too_large_a_file_is_refused_also_when_it_is_packed():
    with pytest.raises(InputError, match="is too large; a drawing has at most 32 MiB"):
        read_drawing(b" " * (MOST_BYTES + 1), "x")
    with pytest.raises(InputError, match="is too large"):
        read_drawing(gzip.compress(b" " * (4 * MOST_BYTES)), "x.svgz")


@pytest.mark.parametrize("schema", ["simulearn.result/1", "simulearn.task/1"])
def test_files_of_our_own_give_their_grid(schema):
    grid = make("dome")
    for value in (grid_to_dict(grid), {"schema": schema, "grid": grid_to_dict(grid)}):
        found = imported(json.dumps(value).encode("utf-8-sig"), "any.name").grid
        assert found.digest == grid.digest
    with pytest.raises(InputError, match="holds no grid"):
        own_grid(json.dumps({"schema": schema}).encode())
    with pytest.raises(InputError, match="schema is missing"):
        own_grid(json.dumps({"joints": [], "beams": []}).encode())


def broken(data, random):
    """Return contents with bytes cut off, flipped, swapped or put in."""
    kind = random.integers(5)
    if kind == 0:
        return data[: random.integers(len(data))]
    if kind == 1:
        flipped = np.frombuffer(data, np.uint8).copy()
        flipped[random.integers(0, len(data), 8)] ^= random.integers(1, 255, 8, np.uint8)
        return flipped.tobytes()
    if kind == 2:
        return random.bytes(int(random.integers(1, 2000)))
    words = data.split(b"," if b"," in data else b" ")
    i, j = random.integers(0, len(words), 2)
    words[i], words[j] = words[j], words[i]
    if kind == 4:
        words[i] = [b"1e999", b"-", b"nan", b"[[[[", b"}", b"\xff", b"1e308", b'"', b""][i % 9]
    return (b"," if b"," in data else b" ").join(words)


@pytest.mark.parametrize("text", [JSON, CSV, OBJ], ids=["JSON", "CSV", "OBJ"])
def test_broken_files_give_a_grid_or_an_error(text):
    random = np.random.default_rng(14)
    texts = []
    for _ in range(120):
        try:
            imported(broken(text.encode(), random), "broken")
        except InputError as error:
            texts.append(str(error))
    assert texts
    assert not any("\n" in text for text in texts)
