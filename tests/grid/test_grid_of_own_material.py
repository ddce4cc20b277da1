"""Grids and tasks that hold a material themselves instead of naming one."""

import dataclasses
import json

import pytest

from simulearn.errors import InputError
from simulearn.grid import grid_from_dict, grid_to_dict, make, read_grid
from simulearn.inverse import read_task, task_from_dict
from simulearn.material import load_material, material_text, name_of, own_material
from simulearn.simulate.checked import Checked, check_all

MINE = own_material(material_text("pla-hot-water").replace("pla-hot-water", "my-pla"))
GRID = grid_to_dict(make("saddle", (1, 1))) | {"material": "my-pla"}


def test_a_grid_holds_its_material_and_is_written_with_its_name():
    grid = grid_from_dict(GRID, materials={"my-pla": MINE})
    assert load_material(grid.material) is MINE
    assert name_of(grid.material) == grid_to_dict(grid)["material"] == "my-pla"
    assert grid.centred.material is MINE
    assert grid.digest != grid_from_dict(GRID).digest
    with pytest.raises(InputError, match="my-pla"):
        load_material(grid_from_dict(GRID).material)


def test_a_path_is_seen_from_here_or_from_the_grids_folder(tmp_path, monkeypatch):
    folder = tmp_path / "designs"
    folder.mkdir()
    text = material_text("pla-hot-water")
    (folder / "mine.toml").write_text(text.replace("width = 7.2", "width = 8.0"))
    grid = GRID | {"material": "mine.toml"}
    goals = [{"vertex": ["joint", 0, "centre"], "target": [0.0, 0.0, 5.0]}]
    task = {"schema": "simulearn.task/1", "grid": grid, "goals": goals}
    (folder / "grid.json").write_text(json.dumps(grid))
    (folder / "task.json").write_text(json.dumps(task))

    def widths():
        task = read_task("designs/task.json", paths=True)
        designs = read_grid("designs/grid.json", paths=True), task.start
        return [load_material(design.material).section.width for design in designs]

    monkeypatch.chdir(tmp_path)
    assert widths() == [8.0, 8.0]
    (tmp_path / "mine.toml").write_text(text)
    assert widths() == [7.2, 7.2]
    (folder / "grid.json").write_text(json.dumps(GRID | {"material": "x" * 999 + ".toml"}))
    with pytest.raises(InputError, match="cannot be read"):
        widths()


def test_materials_of_one_name_are_distinguished():
    wide = MINE.model_copy(update={"section": MINE.section.model_copy(update={"width": 8.0})})
    grid = grid_from_dict(GRID, materials={"my-pla": MINE})
    other = dataclasses.replace(grid, material=wide)
    assert grid.digest != other.digest
    checked = check_all([grid, other, grid])
    assert all(isinstance(one, Checked) for one in checked)
    assert [one.material.section.width for one in checked] == [7.2, 8.0, 7.2]


def test_a_task_begins_from_a_grid_of_its_own_material():
    goals = [{"vertex": ["joint", 0, "centre"], "target": [0.0, 0.0, 5.0]}]
    data = {"schema": "simulearn.task/1", "grid": GRID, "goals": goals}
    task = task_from_dict(data, materials={"my-pla": MINE})
    assert task.start.material is MINE
    assert task.model_dump(by_alias=True)["grid"]["material"] == "my-pla"
    assert task.model_copy(update={"robust": True}).start.material is MINE
    assert task.with_grid(make("saddle", (1, 1))).start.material == "pla-hot-water"
    assert task.with_grid(make("saddle", (1, 1))).with_grid(task.start).start.material is MINE
