"""Configurations: those that are shipped, and what is wrong with others."""

import pytest

from simulearn.dataset import read_config, shipped
from simulearn.errors import InputError
from simulearn.grid import Rules, validate


def test_the_shipped_ones_are_what_they_say():
    assert shipped() == ["2x3", "3x3", "beams-removed", "calibration", "default", "sample"]
    default = read_config("default")
    assert default.trials == 2000
    assert sum(default.is_test(k) for k in range(2000)) == 400
    assert default.rules == Rules()  # the file says what is left out elsewhere
    assert (
        len(read_config("2x3").design(0)[0].beams),
        len(read_config("3x3").design(0)[0].beams),
    ) == (17, 24)
    removed = read_config("beams-removed")
    counts = {len(removed.design(k)[0].beams) for k in range(30)}
    assert max(counts) == 11
    assert min(counts) < 9
    seeds = [read_config(name).seed for name in shipped()]
    assert len(set(seeds)) == len(seeds)


def test_designs_with_beams_removed_are_whole_and_valid():
    config = read_config("beams-removed")
    for k in range(30):
        grid, _ = config.design(k)
        assert validate(grid, config.material).warnings == () or all(
            warning.code.startswith("beam-") for warning in validate(grid, config.material).warnings
        )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("trials = 0", "trials: Input should be greater than or equal to 1"),
        ("speed = 1", "speed: Extra inputs are not permitted"),
        ("[rules]\nlength = [60, 50]", "rules.length: Value error, the values must rise"),
        ("[rules]\ninactive = 1.5", "rules.inactive: Input should be less than or equal to 1"),
        ("[rules]\njitters = 1", "rules.jitters: Unexpected keyword argument"),
        ("[solver]\nslabs = 7", "solver.slabs: Input should be a multiple of 2"),
        ("[rules]\njitter = nan", "rules.jitter: Input should be a finite number"),
        ("a = ", "is not valid TOML"),
        ('[rules]\nmaterial = "gold"', "gold"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, text, words):
    path = tmp_path / "x.toml"
    head = 'name = "x"\n' + ("" if text.startswith("trials") else "trials = 3\n")
    path.write_text(head + text)
    with pytest.raises(InputError) as told:
        read_config(path)
    assert words in str(told.value)


def test_a_name_that_is_nothing_lists_what_there_is():
    with pytest.raises(InputError, match="is neither a file nor one of 2x3, 3x3, beams-removed"):
        read_config("defualt")


def test_a_wrong_command_line(run, tmp_path):
    words = ("dataset", "generate", "sample", "-o", tmp_path, "--scheduler", "x", "--workers", 2)
    code, _, err = run(*words)
    assert code == 1
    assert "--workers is for this machine" in err
