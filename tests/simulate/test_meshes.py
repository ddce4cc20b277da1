"""The fine mesh of finite elements, as the command and the calls offer it."""

import json

import pytest

import simulearn
from simulearn.errors import InputError
from simulearn.fea.layout import MESHES as LAYOUTS
from simulearn.grid import grid_to_dict, make
from simulearn.simulate import ENGINES, engine
from simulearn.simulate.engines import MESHES


@pytest.fixture(scope="module")
def cell(tmp_path_factory):
    path = tmp_path_factory.mktemp("cell") / "cell.json"
    path.write_text(json.dumps(grid_to_dict(make("dome", (1, 1)))))
    return path


def test_the_names_are_those_of_the_layouts():
    assert tuple(LAYOUTS) == MESHES


def test_a_fine_mesh_is_named_on_the_terminal_and_in_the_summary(run, cell, tmp_path):
    code, out, _ = run("simulate", cell, "--mesh", "fine")
    assert code == 0
    assert "fea, fine mesh of 456 bricks" in " ".join(out.split())
    code, out, _ = run("simulate", cell, "--mesh", "fine", "--json", "-o", tmp_path / "a.npz")
    fine = json.loads(out)["summary"]
    assert code == 0
    assert (fine["mesh"], fine["bricks"]) == ("fine", 456)
    assert simulearn.simulate.read_npz(tmp_path / "a.npz").record["mesh"] == "fine"
    _, out, _ = run("simulate", cell, "--json", "-o", tmp_path / "b.npz")
    coarse = json.loads(out)["summary"]
    assert (coarse["mesh"], coarse["bricks"]) == ("default", 72)
    assert 0 < abs(fine["rise_mm"] - coarse["rise_mm"]) < 0.5


@pytest.mark.parametrize("name", [name for name in ENGINES if name != "fea"])
def test_other_engines_take_no_mesh(run, cell, name):
    code, out, err = run("simulate", cell, "--engine", name, "--mesh", "fine")
    assert (code, out) == (1, "")
    assert f'engine "{name}" takes no mesh; only "fea" does' in err


def test_an_unknown_mesh_is_refused_with_those_known(run, cell):
    code, _, err = run("simulate", cell, "--mesh", "coarse")
    assert code == 1
    assert 'mesh "coarse" is not known; known are default, fine' in err
    with pytest.raises(InputError) as info:
        engine("fea", mesh="coarse")
    assert (info.value.code, info.value.where) == ("mesh-unknown", "mesh")


def test_the_call_takes_a_mesh():
    result = simulearn.simulate(make("flat", (1, 1)), mesh="fine")
    assert result.record["mesh"] == "fine"
    assert result.engine == "fea"
