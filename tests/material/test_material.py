"""Material systems are data: another file is another material, and a wrong one is explained."""

from pathlib import Path

import numpy as np
import pytest

from simulearn.errors import InputError
from simulearn.fea import simulate_grid
from simulearn.grid import Grid, make
from simulearn.material import Material, load_material, names
from simulearn.material.material import Laid
from simulearn.material.reading import HERE

PLA = (HERE / "pla-hot-water.toml").read_text(encoding="utf-8")

# A made-up polymer with thinner, wider beams, a linear law and no creep.
RUBBER = (
    PLA.replace('name = "pla-hot-water"', 'name = "rubber-bath"')
    .replace("width = 7.2", "width = 9.0")
    .replace("thickness = 4.0", "thickness = 3.0")
    .replace('kind = "marlow"', 'kind = "neo-hookean"')
    .replace("amplitude = 0.129", "amplitude = 0.0")
)
RUBBER = RUBBER[: RUBBER.index("# nominal strain")] + RUBBER[RUBBER.index("[shrinkage]") :]


def test_pla_comes_with_simulearn() -> None:
    assert "pla-hot-water" in names()
    pla = load_material("pla-hot-water")
    assert pla.section.width == 7.2
    assert pla.shrinkage.passive / pla.shrinkage.active == pytest.approx(0.118 / 0.158)
    assert pla.gravity.body_force == pytest.approx(2.73e-6, rel=1e-2)


def test_assumptions_are_marked_in_the_file() -> None:
    for key in ("modulus", "shell = 0.09", "[creep]"):
        line = next(line for line in PLA.splitlines() if line.startswith(key))
        assert "assumed" in line


def test_another_material_is_another_file(tmp_path: Path) -> None:
    path = tmp_path / "rubber-bath.toml"
    path.write_text(RUBBER, encoding="utf-8")
    rubber = load_material(path)
    flat = make("flat", (1, 1))
    grid = Grid(flat.joints, flat.beams, [1, 0, 0, -1], 0, str(path))
    trial = simulate_grid(grid, rubber)
    assert np.ptp(trial.joints[0, :, :, 2]) == pytest.approx(3.0)
    width = np.linalg.norm(trial.beams[0, :, 1, 1] - trial.beams[0, :, 1, 0], axis=-1)
    np.testing.assert_allclose(width, 9.0)
    assert trial.record["law"] == "neo-hookean"
    np.testing.assert_allclose(trial.joints[11], trial.joints[10], atol=1e-6)  # no creep
    assert np.linalg.norm(trial.joints[10] - trial.joints[0], axis=-1).max() > 5


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("width = 7.2", "width = -1", "section.width"),
        ("width = 7.2", "width = nan", "section.width"),
        ("shell = 0.9 ", "shell = 4.0 ", "no core"),
        ("poisson = 0.406", "poisson = 0.6", "poisson"),
        ("[0.001059, 0.003429]", "[0.5, 0.003429]", r"table\[1\]"),
        ('kind = "marlow"', 'kind = "magic"', "magic"),
        ("hold = 600.0", "hold = 600.0\nhalf = 1", "creep.half"),
        ("[section]", "[section", "not valid TOML"),
        ("width = 7.2\n", "", r"section\.width is missing"),
        ("width = 7.2", 'width = "7.2 mm"', "without quotes and without a unit"),
        ("width = 7.2", "width = true", r"section\.width is True"),
        ("width = 7.2", "width = 720.0", r"between 0\.1 and 100 mm"),
        ("density = 1.25e-9", "density = 1250.0", "tonne/mm3"),
        ("active = 0.09261", "active = 9.261", r"shrinkage\.active is 9\.261; .*less than 1"),
        ('kind = "marlow"', 'kind = "neo-hookean"', r"law\.table is an unknown key"),
        ("[limits]", "[laid]\nwidth = 1.8\nthickness = 4\n[limits]", "leave no core in the 1.8"),
        ('name = "pla-hot-water"', 'name = ""', "a name has 1 to 80"),
        ('name = "pla-hot-water"', 'name = "a\\nb"', "a name has 1 to 80"),
    ],
)
def test_a_wrong_file_is_explained(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in PLA
    path = tmp_path / "wrong.toml"
    path.write_text(PLA.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=message) as caught:
        load_material(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)
    assert caught.value.code in ("material-file", "material-name")


def test_an_unknown_material_names_the_known_ones() -> None:
    with pytest.raises(InputError, match=r'"pla" is not known; known are .*pla-hot-water'):
        load_material("pla")


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        load_material(tmp_path / "none.toml")


def test_a_digest_is_of_the_contents():
    plain = load_material("pla-hot-water")
    light = plain.model_copy(
        update={"gravity": plain.gravity.model_copy(update={"acceleration": 0.0})}
    )
    assert light.digest != plain.digest
    assert light.physics != plain.physics
    renamed = plain.model_copy(update={"name": "other", "title": "Other"})
    assert renamed.digest == plain.digest
    narrow = plain.model_copy(
        update={"limits": plain.limits.model_copy(update={"beam_length": 50.0})}
    )
    assert narrow.digest != plain.digest
    assert narrow.physics == plain.physics  # no simulation depends on it


def test_a_material_that_says_nothing_of_how_it_is_laid_has_the_digest_that_it_had():
    plain = load_material("pla-hot-water")
    assert plain.digest.startswith("251e102c4778")  # models, trials and documents go by it
    laid = plain.model_copy(update={"laid": Laid(width=7.0, thickness=4.0)})
    assert laid.digest != plain.digest
    assert laid.physics == plain.physics
    assert Material.model_validate_json(laid.model_dump_json()) == laid
    assert "laid" not in plain.model_dump()


def test_an_edited_file_is_another_material(tmp_path):
    text = (HERE / "pla-hot-water.toml").read_text("utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(text, "utf-8")
    before = load_material(path)
    path.write_text(text.replace("acceleration = 2182.0", "acceleration = 0.0"), "utf-8")
    assert load_material(path).gravity.acceleration == 0
    assert load_material(path).digest != before.digest


def test_a_shipped_material_is_read_once(monkeypatch):
    from simulearn.material import reading

    def counted(path):
        paths.append(path)
        return original(path)

    paths, original = [], reading.read_material
    monkeypatch.setattr(reading, "read_material", counted)
    reading._shipped.cache_clear()
    assert all(load_material("pla-hot-water") is load_material("pla-hot-water") for _ in range(50))
    assert len(paths) == 1


@pytest.mark.parametrize("name", ["..", "", "a\0b", "x" * 300])
def test_odd_names_are_not_known(name):
    with pytest.raises(InputError, match="is not known"):
        load_material(name)
