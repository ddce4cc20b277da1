"""Configurations: those that are shipped, and what is wrong with others."""

import pytest

from simulearn.dataset import read_config, shipped
from simulearn.errors import InputError
from simulearn.grid import Rules, validate


def test_the_shipped_ones_are_what_they_say():
    lattices = ["2x3", "3x3", "beams-removed", "calibration", "default", "default-more", "sample"]
    families = ["family", "family-bound", "family-fine", "family-kept-out", "family-test"]
    assert shipped() == sorted([*lattices, *families])
    default = read_config("default")
    assert default.trials == 2000
    assert sum(default.is_test(k) for k in range(2000)) == 400
    assert default.rules == Rules()  # the file says what is left out elsewhere
    assert (
        len(read_config("2x3").design(0).grid.beams),
        len(read_config("3x3").design(0).grid.beams),
    ) == (17, 24)
    removed = read_config("beams-removed")
    counts = {len(removed.design(k).grid.beams) for k in range(30)}
    assert max(counts) == 11
    assert min(counts) < 9
    seeds = [read_config(name).seed for name in shipped()]
    assert len(set(seeds)) == len(seeds)


def test_families_have_kinds_and_members_and_some_kinds_are_kept_out():
    learnt, test, kept = (read_config(f"family{x}") for x in ("", "-test", "-kept-out"))
    assert set(test.kinds.shares) == set(learnt.kinds.shares)
    assert not set(kept.kinds.shares) & set(learnt.kinds.shares)
    assert len(kept.kinds.shares) == 3
    bound = set(read_config("family-bound").kinds.shares)
    assert not bound & (set(kept.kinds.shares) | set(learnt.kinds.shares))
    designs = [test.design(k) for k in range(20)]
    assert len({design.material.physics for design in designs}) > 12
    assert len({design.kind for design in designs}) > 4
    assert not learnt.solver.layout.core
    assert test.solver.layout.core == kept.solver.layout.core == 1


def test_designs_with_beams_removed_are_whole_and_valid():
    config = read_config("beams-removed")
    for k in range(30):
        grid = config.design(k).grid
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
    with pytest.raises(InputError) as raised:
        read_config(path)
    assert words in str(raised.value)


def test_a_name_that_is_nothing_lists_what_there_is():
    with pytest.raises(InputError, match="is neither a file nor one of 2x3, 3x3, beams-removed"):
        read_config("defualt")


def test_a_wrong_command_line(run, tmp_path):
    words = ("dataset", "generate", "sample", "-o", tmp_path, "--scheduler", "x", "--workers", 2)
    code, _, err = run(*words)
    assert code == 1
    assert "--workers is for this machine" in err
