"""The packed file: exact to its step, whole or refused, and summed up in figures."""

import json

import h5py
import numpy as np
import pytest

from simulearn.dataset import checksum, pack, read_dataset
from simulearn.dataset.pack import _Writer
from simulearn.dataset.packed import _positions
from simulearn.dataset.trial import TrialJob, read_trial
from simulearn.errors import InputError


@pytest.fixture(scope="module")
def file(folder, tmp_path_factory):
    path = tmp_path_factory.mktemp("packed") / "small.h5"
    assert pack(folder, path) == 12
    return path


def test_it_holds_the_trials_to_half_a_step(file, folder, small):
    data = read_dataset(file)
    (batch,) = data.batches
    assert batch.joints.shape == (12, 12, 4, 8, 3)
    assert batch.sections.shape == (12, 12, 4, 3, 4, 3)
    assert batch.stress is not None
    for t, k in enumerate(batch.numbers):
        design = small.design(int(k))
        grid = design.grid
        trial = read_trial(folder / "trials" / f"{TrialJob.of(design, small).key}.npz")
        assert abs(trial.joints - batch.joints[t]).max() < 0.00251
        assert abs(trial.beams - batch.sections[t]).max() < 0.00251
        assert abs(trial.stress - batch.stress[t]).max() < 0.51e-5
        np.testing.assert_array_equal(batch.grid(t).joints, grid.joints)
        np.testing.assert_array_equal(batch.grid(t).actuators, grid.actuators)
        assert data.records[int(k)] == trial.record
    assert data.config == small


def test_splits_share_no_trial_and_make_the_whole(file):
    parts = [read_dataset(file, split, stress=False).batches[0] for split in ("train", "test")]
    assert [len(part) for part in parts] == [9, 3]
    assert parts[0].stress is None
    assert set(parts[1].numbers) == {3, 7, 11}
    assert sorted(np.concatenate([part.numbers for part in parts])) == list(range(12))


def test_taking_trials_takes_all_of_them(file):
    batch = read_dataset(file).batches[0]
    part = batch.take([2, 5])
    assert len(part) == 2
    np.testing.assert_array_equal(part.stress, batch.stress[[2, 5]])
    assert batch.take(batch.test).numbers.tolist() == [3, 7, 11]


def test_every_array_says_its_axes_and_unit(file):
    with h5py.File(file) as stored:
        for group in stored["topologies"].values():
            for name, item in group.items():
                assert item.attrs["axes"], name
                if item.dtype == np.int16 or "first" in name:
                    assert item.attrs["step"] > 0


def test_a_grid_that_hangs_down_far_needs_wider_increments(file, tmp_path):
    trials = [np.zeros((12, 4, 8, 3), np.float32) for _ in range(2)]
    trials[1][1:] = -200.0
    with h5py.File(tmp_path / "x.h5", "w") as stored:
        _Writer(stored.create_group("g")).positions("joints", trials)
        assert stored["g/joints_increments"].dtype == np.int32
        found = _positions(stored["g"], "joints", np.array([0, 1]))
    np.testing.assert_allclose(found, trials, atol=0.0026)


def test_the_checksum_is_that_of_the_contents(file, tmp_path):
    recorded, found = checksum(file)
    assert recorded == found
    changed = tmp_path / "changed.h5"
    changed.write_bytes(file.read_bytes())
    with h5py.File(changed, "r+") as stored:
        stored["topologies/0000/actuators"][0, 0] += 0.25
    recorded, found = checksum(changed)
    assert recorded != found


def test_an_unfinished_run_is_packed_only_on_request(folder, small, tmp_path):
    from simulearn.dataset.generate import Folder

    more = Folder(tmp_path / "set", small.model_copy(update={"trials": 14}))
    for trial in (folder / "trials").iterdir():
        (more.path / "trials" / trial.name).write_bytes(trial.read_bytes())
    with pytest.raises(InputError, match="2 of 14 trials are not there yet, or are torn"):
        pack(more.path, tmp_path / "x.h5")
    assert not (tmp_path / "x.h5").exists()
    assert pack(more.path, tmp_path / "x.h5", partial=True) == 12


def test_a_locked_file_is_reported(file):
    fcntl = pytest.importorskip("fcntl")
    with file.open("rb+") as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        with pytest.raises(InputError, match=r"is locked .* HDF5_USE_FILE_LOCKING"):
            read_dataset(file)


def test_what_is_no_set_is_refused(file, folder, tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        read_dataset(tmp_path / "none.h5")
    with pytest.raises(InputError, match=r"is not the folder of a data set \(no config.json\)"):
        pack(tmp_path, tmp_path / "x.h5")
    text = tmp_path / "text.h5"
    text.write_text("hello")
    with pytest.raises(InputError, match="is not an HDF5 file, or is damaged"):
        read_dataset(text)
    half = tmp_path / "half.h5"
    half.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    with pytest.raises(InputError, match="damaged"):
        read_dataset(half)
    foreign = tmp_path / "foreign.h5"
    with h5py.File(foreign, "w") as stored:
        stored["x"] = 1
    with pytest.raises(InputError, match="not a data set of this version"):
        read_dataset(foreign)
    with h5py.File(foreign, "w") as stored:
        stored.attrs["schema"] = "simulearn.dataset/1"
    with pytest.raises(InputError, match="is damaged"):
        read_dataset(foreign)


def test_a_damaged_trial_is_named(folder, small, tmp_path):
    from simulearn.dataset.generate import Folder

    copy = Folder(tmp_path / "set", small)
    for trial in (folder / "trials").iterdir():
        (copy.path / "trials" / trial.name).write_bytes(trial.read_bytes()[:5000])
    with pytest.raises(InputError, match="12 of 12 trials are not there yet, or are torn"):
        pack(copy.path, tmp_path / "x.h5")


def test_info_tells_the_figures_and_draws_them(file, run, tmp_path):
    picture = tmp_path / "info.png"
    code, out, _ = run("dataset", "info", file, "-o", picture)
    assert code == 0
    assert "small: 12 trials (9 to learn, 3 to test)" in out
    assert picture.stat().st_size > 20_000
    figures = json.loads(run("dataset", "info", file, "--json")[1])
    batch = read_dataset(file).batches[0]
    assert figures["quantities"]["dimension"]["mean"] == pytest.approx(batch.dimensions.mean())
    assert figures["quantities"]["dimension"]["paper"]["mean"] == 94.44
    assert (figures["failed"], figures["joints"], figures["beams"]) == (0, [4], [4])


def test_info_finds_damage(file, run, tmp_path):
    changed = tmp_path / "changed.h5"
    changed.write_bytes(file.read_bytes())
    with h5py.File(changed, "r+") as stored:
        stored["topologies/0000/flat"][0, 0, 0] += 1
    code, _, err = run("dataset", "info", changed)
    assert code == 1
    assert "is damaged (its SHA-256 is" in err


def test_pack_by_the_command_line(folder, run, tmp_path, file):
    code, out, _ = run("dataset", "pack", folder, "-o", tmp_path / "b.h5")
    assert code == 0
    assert "12 trials" in out
    assert (tmp_path / "b.h5").read_bytes() == file.read_bytes()
    code, _, err = run("dataset", "pack", folder, "-o", tmp_path / "no" / "b.h5")
    assert code == 1
    assert "does not exist" in err
