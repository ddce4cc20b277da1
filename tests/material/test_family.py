"""The family of materials: numbers without unit, random members, what is the same grid."""

import numpy as np
import pytest

from simulearn.errors import InputError
from simulearn.fea import COARSE, FINE, simulate_grid
from simulearn.fea.bar import bar, curvature
from simulearn.grid import make
from simulearn.material import Family, draw_member, load_material, member_of, read_material
from simulearn.material.reading import HERE

PLA = load_material("pla-hot-water")


def changed(material=PLA, **parts):
    """A material with some values changed: section=dict(width=...), and so on."""
    return material.model_copy(
        update={
            name: getattr(material, name).model_copy(update=values)
            for name, values in parts.items()
        }
    )


def test_nominal_numbers():
    member = member_of(PLA)
    assert member.strain == 0.09261
    assert member.passive == member.joint == pytest.approx(0.118 / 0.158)
    assert member.shell == 1
    assert member.curl == 0
    assert member.slender == 1.8
    assert member.weight == pytest.approx(1.25e-9 * 2182 * 4 / 2.2)


def test_members_are_drawn_within_the_family_and_differ():
    family = Family()
    members = [draw_member(family, PLA, np.random.default_rng(k).random) for k in range(60)]
    numbers = np.array([member_of(m) for m in members])
    nominal = member_of(PLA)
    for name, values in zip(nominal._fields, numbers.T, strict=True):
        low, high = getattr(family, name)
        scale = getattr(nominal, name) if name in ("strain", "weight") else 1.0
        assert low * scale - 1e-9 <= values.min() < values.max() <= high * scale + 1e-9
    assert len({m.physics for m in members}) == 60


def test_a_part_of_the_members_may_be_the_material_itself():
    family = Family(nominal=0.5)
    same = [draw_member(family, PLA, np.random.default_rng(k).random) is PLA for k in range(200)]
    assert 0.35 < np.mean(same) < 0.65


@pytest.mark.parametrize("curl", [0.02, -0.02])
@pytest.mark.parametrize(("layout", "within"), [(COARSE, 0.05), (FINE, 0.007)])
def test_an_unactuated_beam_bends_by_its_own_curl_over_its_thickness(curl, layout, within):
    weightless = changed(gravity={"acceleration": 0.0}, shrinkage={"curl": curl})
    trial = simulate_grid(bar(50.0, 0.0, weightless), weightless, layout)
    bent = np.radians(curvature(trial.solid, trial.displacements[10]))
    assert bent == pytest.approx(curl / 4, rel=within)


def test_a_section_of_half_the_size_is_half_the_weight():
    """Lengths count in thicknesses: half of all lengths under twice the specific weight."""
    grid = make("saddle", (1, 1), 40.0)
    whole = simulate_grid(grid, PLA)
    small = changed(
        section={"width": 3.6, "thickness": 2.0, "shell": 0.45},
        gravity={"density": 2 * PLA.gravity.density},
    )
    half = simulate_grid(type(grid)(grid.joints / 2, grid.beams, grid.actuators, grid.fixed), small)
    np.testing.assert_allclose(2 * half.joints, whole.joints, atol=2e-3)


def test_twice_the_stiffness_is_half_the_weight():
    grid = make("cone", (1, 1), 50.0)
    stiff, light = changed(law={"scale": 2.0}), changed(gravity={"density": 0.625e-9})
    a, b = simulate_grid(grid, stiff), simulate_grid(grid, light)
    np.testing.assert_allclose(a.joints, b.joints, atol=1e-3)
    np.testing.assert_allclose(a.stress[-1], 2 * b.stress[-1], atol=2e-3)


def test_a_larger_strain_is_a_longer_release():
    """Release to .5 of a strain is release to 1 of half of it."""
    grid = make("bowl", (1, 1), 50.0)
    shrinkage = PLA.shrinkage
    half = changed(shrinkage={"active": shrinkage.active / 2, "shell": shrinkage.shell / 2})
    a, b = simulate_grid(grid, PLA), simulate_grid(grid, half)
    np.testing.assert_allclose(a.joints[5], b.joints[10], atol=1e-3)


def test_a_material_file_may_say_its_own_curl_and_scatter(tmp_path):
    text = (HERE / "pla-hot-water.toml").read_text("utf-8")
    text = text.replace("curl = 0.0 ", "curl = 0.01")
    text = text[: text.index("[scatter]")] + text[text.index("[bath]") :]
    file = tmp_path / "mine.toml"
    file.write_text(text + "\n[scatter]\nprint = 0.03\nbeam = 0.02\n", "utf-8")
    material = read_material(file)
    assert material.shrinkage.curl == 0.01
    assert (material.scatter.print, material.scatter.beam) == (0.03, 0.02)
    assert material.physics != PLA.physics
    file.write_text(text + "\n[scatter]\nprint = -1\n", "utf-8")
    with pytest.raises(InputError, match=r"scatter\.print"):
        read_material(file)
