"""Which format a file's name asks for."""

from pathlib import Path

import pytest

from simulearn import outputs
from simulearn.errors import InputError


@pytest.mark.parametrize(
    ("name", "ending"),
    [
        ("a.glb", ".glb"),
        ("a.morph.glb", ".morph.glb"),
        ("A.Morph.GLB", ".morph.glb"),
        ("folder.morph.glb/a.glb", ".glb"),
        ("morph.glb", ".glb"),
        ("v1.2.3dm", ".3dm"),
        ("two words.tar.csv", ".csv"),
    ],
)
def test_the_longest_ending_wins(name, ending):
    assert outputs.ending_of(Path(name)) == ending


@pytest.mark.parametrize("name", ["a", "a.exe", ".glb", "a.glb.txt", "glb", "a."])
def test_other_names_are_refused_with_what_there_is(name):
    with pytest.raises(InputError, match=r"not one of .*\.png .*\.morph\.glb") as raised:
        outputs.ending_of(Path(name))
    assert str(raised.value).startswith(name)


def test_help_and_server_list_the_same_formats(run):
    code, text, _ = run("simulate", "--help")
    assert code == 0
    words = text.replace("│", " ").split()
    assert [e for e in outputs.WRITERS if e not in words and f"{e}." not in words] == []


def test_every_format_is_written_by_its_ending_in_capitals(tmp_path):
    import synthetic

    result = synthetic.result(synthetic.square_grid((1, 1)), solid=False)
    for ending in outputs.WRITERS:
        if ending not in outputs.FILMS:
            path = tmp_path / f"a{ending.upper()}"
            outputs.write(result, path)
            assert path.stat().st_size > 100
