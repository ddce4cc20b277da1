"""Fitting the models that solve for equilibrium: losses fall, runs go on, errors are estimated."""

import json
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from simulearn.cli.program import app
from simulearn.errors import InputError
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.model import Designs
from simulearn.learn.config import config_of, read_config
from simulearn.learn.equilibrium import stages
from simulearn.learn.equilibrium.bound import ErrorBound, beyond, class_of
from simulearn.learn.equilibrium.bound_fit import fitted_bound
from simulearn.learn.equilibrium.config import EquilibriumConfig
from simulearn.learn.equilibrium.model import Equilibrium
from simulearn.learn.equilibrium.signs import structure_of
from simulearn.learn.equilibrium.train import train
from simulearn.learn.run import new_bound, run


@pytest.fixture(scope="module")
def config(sample_file) -> EquilibriumConfig:
    stage = {"updates": 40, "batch": 4, "rate": 0.1}
    data = {
        "name": "little", "kind": "equilibrium", "data": str(sample_file), "validation": 2,
        "calibration": str(sample_file), "width": 8, "message": 2, "rounds": 1,
        "law": stage, "network": {**stage, "rate": 2e-3}, "stress": {**stage, "rate": 1e-2},
    }  # fmt: skip
    return config_of(data, "little")


@pytest.fixture(scope="module", autouse=True)
def short_rounds():
    before, stages.ROUND = stages.ROUND, 10
    yield
    stages.ROUND = before


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fit")


@pytest.fixture(scope="module")
def fitted(config, sample, folder):
    progress = []
    bundle, rows, percent = run(config, sample, folder, lambda *x: progress.append(x))
    return bundle, rows, percent, progress


def test_every_stage_gets_better(fitted):
    bundle, rows, percent, progress = fitted
    for stage in ("law", "network", "stress"):
        part = [row for row in rows if row.stage == stage]
        assert [row.update for row in part] == [10, 20, 30, 40]
        assert part[-1].loss < part[0].loss
    assert progress[-1][1:] == (120, 120)
    assert percent < 5  # mechanics alone, hardly fitted
    assert bundle_of(bundle.path).model.kind == "equilibrium"


def test_the_curve_is_kept(fitted, folder):
    lines = (folder / "loss.csv").read_text("utf-8").splitlines()
    assert lines[0] == "stage,update,loss,seconds"
    assert len(lines) == 1 + 12


def test_a_finished_run_has_nothing_left_to_do(config, sample, fitted, folder):
    again, rows = train(config, sample, folder)
    assert [row.loss for row in rows] == [row.loss for row in fitted[1]]
    for name, value in fitted[0].model.to_arrays().items():
        np.testing.assert_array_equal(again.to_arrays()[name], value)


def test_a_stopped_run_goes_on_bit_for_bit(config, sample, fitted, tmp_path):
    """The stage of the section model alone, which is the same in both kinds."""
    data = config.model_dump() | {"network": None, "stress": None, "calibration": None}
    beams = config_of(data | {"kind": "beams"}, "little")

    def stop(row, done, total):
        if row is not None and done == 20:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        train(beams, sample, tmp_path, stop)
    model, rows = train(beams, sample, tmp_path)
    assert [row.loss for row in rows] == [row.loss for row in fitted[1][:4]]
    for name, value in model.to_arrays().items():
        np.testing.assert_array_equal(value, fitted[0].model.to_arrays()[name])


def test_a_checkpoint_of_another_run_is_refused(config, sample, fitted, folder):
    with pytest.raises(InputError, match="is of another run"):
        train(config, replace(sample, sha256="other"), folder)


def test_a_run_goes_on_from_a_model(config, sample, fitted, tmp_path):
    polish = {"polish": {"updates": 10, "batch": 4, "rate": 2e-3}, "stress": None}
    further = config_of({**config.model_dump(), **polish}, "further")
    bundle, rows, _ = run(further, sample, tmp_path, lambda *_: None, begin=fitted[0])
    assert [row.stage for row in rows] == ["polish"]
    before, after = fitted[0].model.to_arrays(), bundle.model.to_arrays()
    same = {name for name in before if np.array_equal(before[name], after.get(name))}
    parts = {name.partition(".")[0] for name in before if name not in same}
    assert parts == {"network", "trust"}  # the law and the network for stresses stay
    assert bundle.card.training["begin"]["weights"] == fitted[0].card.weights


def test_what_a_run_cannot_go_on_from(config, sample, fitted, tmp_path):
    model = fitted[0].model
    polish = {"updates": 10}
    further = config_of({**config.model_dump(), "polish": polish}, "further")
    with pytest.raises(InputError, match="has no polish"):
        train(config, sample, begin=model)
    with pytest.raises(InputError, match="has no network"):
        train(further, sample, begin=bundle_of("beams").model)
    with pytest.raises(InputError, match=r"are \(64, 16, 2\), those of the run \(8, 2, 1\)"):
        train(further, sample, begin=bundle_of("equilibrium").model)
    with pytest.raises(InputError, match="only runs and models of the kind equilibrium"):
        run(further, sample, tmp_path, lambda *_: None, begin=bundle_of("paper"))
    both = ["train", "equilibrium", "--from", "equilibrium", "--bound-of", "equilibrium"]
    assert "exclude each other" in str(CliRunner().invoke(app, both).exception)


def test_a_network_belongs_to_its_kind(config):
    data = config.model_dump()
    with pytest.raises(InputError, match="kind beams has none"):
        config_of({**data, "kind": "beams"}, "x")
    with pytest.raises(InputError, match="kind equilibrium has a network"):
        config_of({**data, "network": None}, "x")


def test_configurations_that_come_along_fit_their_bundles():
    for name in ("equilibrium", "beams"):
        config, card = read_config(name), bundle_of(name).card
        assert card.kind == config.kind
        assert card.training["law"] == config.model_dump(mode="json")["law"]


def drawn(rng, count, kinds=10):
    """Return signs, errors, classes and folds of random trials, whose spread grows with a sign."""
    sign = np.stack([np.ones(count), rng.normal(size=count), rng.normal(size=count)], axis=1)
    loops = rng.integers(3, size=count)
    spread = 0.3 * np.exp(0.5 * sign[:, 2]) * np.array([2.0, 1.0, 1.0])[loops]
    error = np.exp(0.5 * sign[:, 1] + spread * rng.normal(size=count))
    return sign, error, loops, np.arange(count) % kinds


def test_an_estimate_that_nine_of_ten_stay_below():
    rng = np.random.default_rng(0)
    found = fitted_bound(*drawn(rng, 2000))
    sign, error, loops, _ = drawn(rng, 6000)
    below = error <= found.of(sign, loops)
    assert found.weights[1] == pytest.approx(0.5, abs=0.05)
    for some in (loops == 0, loops == 1, loops == 2):
        assert below[some].mean() == pytest.approx(0.9, abs=0.02)
    for some in (sign[:, 2] > 0.5, sign[:, 2] < -0.5):  # 0.78 and 0.98 if all scattered alike
        assert below[some].mean() == pytest.approx(0.9, abs=0.06)


def test_an_estimate_holds_for_a_kind_that_is_not_learnt():
    rng = np.random.default_rng(0)
    kinds = np.repeat(np.arange(30), 40)
    own = 0.5 * rng.normal(size=30)[kinds]  # by which a kind is worse than its signs say
    sign = np.stack([np.ones(1200), rng.normal(size=1200), *rng.normal(size=(20, 1200))], axis=1)
    sign[:, 2:] += rng.normal(size=(30, 20))[kinds]  # by which every kind could be told
    error = np.exp(0.5 * sign[:, 1] + own + 0.1 * rng.normal(size=1200))
    loops = np.full(1200, 2)
    covered = []
    for new in range(0, 30, 3):
        old = kinds != new
        found = fitted_bound(sign[old], error[old], loops[old], kinds[old])
        covered.append((error[~old] <= found.of(sign[~old], loops[~old])).mean())
    assert np.mean(covered) >= 0.85


def test_a_class_of_few_trials_has_the_margin_of_all():
    sign, error, loops, folds = drawn(np.random.default_rng(0), 300)
    loops[:] = 2
    loops[:5] = 0
    margins = fitted_bound(sign, error, loops, folds).margins
    assert margins[0] == margins[1] == pytest.approx(margins[2], abs=0.1)


@pytest.mark.parametrize(
    ("grid", "loops", "free", "depth"),
    [
        ([[0, 1], [1, 2], [2, 3]], 0, 2 / 3, 2),  # a chain
        ([[0, 1], [1, 2], [2, 3], [3, 0]], 1, 0, 4 / 3),
        ([[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]], 2, 0, 1),
    ],
)
def test_how_grids_hang_together(grid, loops, free, depth):
    joints = np.random.default_rng(0).normal(size=(1, 4, 2))
    designs = Designs(np.array(grid), 0, joints, np.zeros((1, len(grid))))
    found = structure_of(designs)
    assert found.loops == loops
    assert found.free == pytest.approx(free)
    assert found.depth == pytest.approx(np.log(depth))
    assert class_of(designs) == min(loops, 2)


def test_an_estimate_is_fitted_anew(config, fitted, tmp_path):
    before = fitted[0].model.to_arrays()
    made = new_bound(fitted[0], config, tmp_path)
    for name, value in bundle_of(made.path).model.to_arrays().items():
        np.testing.assert_allclose(value, before[name], rtol=1e-9, err_msg=name)
    file = tmp_path / "other.toml"
    words = config.model_dump(mode="json")
    lines = [f"{k} = {json.dumps(words[k])}" for k in ("name", "kind", "data", "calibration")]
    lines += ["[law]", "updates = 1", "[network]", "updates = 1"]
    file.write_text("\n".join(lines), "utf-8")
    result = CliRunner().invoke(
        app, ["train", str(file), "--bound-of", str(made.path), "-o", str(tmp_path / "again")]
    )
    assert result.exit_code == 0, result.output
    assert bundle_of(tmp_path / "again" / "model").identity.digest == made.identity.digest
    with pytest.raises(InputError, match="has no calibration set"):
        new_bound(made, config.model_copy(update={"calibration": None}), tmp_path)
    with pytest.raises(InputError, match='models of kind "paper" have no estimate'):
        new_bound(bundle_of("paper"), config, tmp_path)


def test_a_set_of_ones_own_is_learnt_from_alone(sample_file, tmp_path):
    file = tmp_path / "own.toml"
    head = ['name = "own"', 'kind = "beams"', 'more = ["none.h5"]']
    head += [f'{key} = "none.h5"' for key in ("data", "calibration", "unfamiliar", "fine")]
    file.write_text("\n".join([*head, "[law]", "updates = 10", "batch = 4"]), "utf-8")
    result = CliRunner().invoke(
        app, ["train", str(file), "--data", str(sample_file), "-o", str(tmp_path / "run")]
    )
    assert result.exit_code == 0, result.output
    assert "too few for an error estimate" in result.output
    made = bundle_of(tmp_path / "run" / "model")
    assert made.card.training["calibration"] is None
    assert made.model.bound is None
    again = CliRunner().invoke(app, ["train", str(file), "-o", str(tmp_path / "other")])
    assert "none.h5: there is no such data set" in str(again.exception)


def test_a_set_of_ones_own_keeps_a_fifth_aside(config):
    large = config.model_copy(update={"validation": 200})
    assert [large.of_own("x.h5", n).validation for n in (3, 60, 5000)] == [1, 12, 200]
    assert large.of_own("x.h5", 60).calibration is None


def test_outside_the_ranges_the_bound_grows(fitted):
    bound = fitted[0].model.bound
    low, high = 4.0 * bound.ranges[:, 0]  # in thicknesses of PLA's section
    beams = np.array([[0, 1], [0, 2]])

    def of(size):
        flat = np.array([[[0, 0], [size, 0], [0, 50.0]]])
        return Designs(beams, 0, flat, np.zeros((1, 2)))

    assert beyond(of((low + high) / 2), bound.ranges)[0] == 0
    assert beyond(of(high + (high - low)), bound.ranges)[0] >= 1
    assert isinstance(bound, ErrorBound)


def test_the_default_model_estimates_its_error(sample):
    model = bundle_of("default").model
    assert isinstance(model, Equilibrium)
    batch = sample.batches[0]
    designs = Designs(batch.beams, batch.fixed, batch.flat[:8].astype(float), batch.actuators[:8])
    frames = model.rollout(designs)
    assert frames.converged.all()
    assert (frames.bound_mm > 0.01).all()
    assert (frames.bound_mm < 5).all()
