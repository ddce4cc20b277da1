"""Bundles: the same bits back, and a clear word about whatever is wrong."""

import json

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from simulearn.errors import InputError
from simulearn.learn.common import bundle as bundles
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.saving import add_metrics, save_bundle


@pytest.fixture
def saved(model, small, sample, tmp_path):
    return save_bundle(tmp_path / "tiny", model, "tiny", sample, small.model_dump(mode="json"))


def edit(bundle, **changes):
    file = bundle.path / "model.json"
    card = json.loads(file.read_text("utf-8"))
    file.write_text(json.dumps({**card, **changes}), encoding="utf-8")


def test_saved_and_loaded_it_answers_with_the_same_bits(saved, model, designs):
    loaded = bundle_of(saved.path).model
    a, b = model.rollout(designs), loaded.rollout(designs)
    np.testing.assert_array_equal(a.joints, b.joints)
    np.testing.assert_array_equal(a.sections, b.sections)


def test_the_card_tells_where_the_model_comes_from(saved, sample, small):
    card = bundle_of(saved.path).card
    batches = [b.take(~b.test) for b in sample.batches]
    dimensions = np.concatenate([b.dimensions for b in batches])
    low, high = card.range.dimension
    assert low <= dimensions.min() < low + 0.1001
    assert high - 0.1001 < dimensions.max() <= high
    assert card.data.sha256 == sample.sha256
    assert card.data.trials == len(dimensions)
    assert card.training["seed"] == small.seed
    assert card.kind == "paper"
    assert card.units["length"] == "mm"


def test_figures_are_added_to_the_card(saved):
    measured = add_metrics(saved, "sample", {"mean_percent": 3.0})
    assert bundle_of(measured.path).card.metrics == {"sample": {"mean_percent": 3.0}}
    assert bundle_of(measured.path).model is not None


def test_a_bundle_is_replaced_and_other_folders_are_not(saved, model, sample, tmp_path):
    save_bundle(saved.path, model, "again", sample)
    assert bundle_of(saved.path).card.name == "again"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["tiny"]
    other = tmp_path / "letters"
    other.mkdir()
    (other / "dear.txt").write_text("...", encoding="utf-8")
    with pytest.raises(InputError, match="holds other files"):
        save_bundle(other, model, "tiny", sample)
    assert (other / "dear.txt").exists()


def test_what_is_no_model_is_reported(tmp_path):
    with pytest.raises(InputError, match=r"is not a model \(a folder"):
        bundle_of(tmp_path)
    (tmp_path / "model.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="not valid JSON"):
        bundle_of(tmp_path)
    (tmp_path / "model.json").write_text("[]", encoding="utf-8")
    with pytest.raises(InputError, match="not a model of this version"):
        bundle_of(tmp_path)


def test_another_version_or_kind_is_reported(saved):
    edit(saved, schema="simulearn.model/9")
    with pytest.raises(InputError, match=r"simulearn\.model/9"):
        bundle_of(saved.path)
    edit(saved, schema="simulearn.model/1", kind="oracle")
    with pytest.raises(InputError, match='kind "oracle" is not known; known are paper'):
        bundle_of(saved.path)
    edit(saved, kind="paper", ranges={"dimension": [1.0], "beam_length": [1, 2]})
    with pytest.raises(InputError, match=r"ranges\.dimension"):
        bundle_of(saved.path)


def test_damaged_or_missing_weights_are_reported(saved):
    file = saved.path / "weights.safetensors"
    content = file.read_bytes()
    file.write_bytes(content[:-1] + b"!")
    with pytest.raises(InputError, match="is damaged"):
        _ = bundle_of(saved.path).model
    file.unlink()
    with pytest.raises(InputError, match="cannot be read"):
        _ = bundle_of(saved.path).model


def test_a_git_lfs_pointer_is_recognised_also_by_validate(saved, run):
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:abab\nsize 1234567\n"
    (saved.path / "weights.safetensors").write_text(pointer, "utf-8")
    with pytest.raises(InputError, match=r"is a Git LFS pointer, .* `git lfs pull`"):
        _ = bundle_of(saved.path).model
    code, _, err = run("validate", "saddle", "--model", saved.path)
    assert code == 1
    assert "is a Git LFS pointer" in err


def test_torn_weights_are_found_by_validate(saved, run):
    assert run("validate", "saddle", "--model", saved.path)[0] == 0
    file = saved.path / "weights.safetensors"
    file.write_bytes(file.read_bytes()[:-100])
    code, _, err = run("validate", "saddle", "--model", saved.path)
    assert code == 1
    assert "is damaged" in err


@pytest.mark.parametrize(
    ("version", "words"),
    [
        ("9.0.0", "the model is of SimuLearn 9.0.0, this is .*: update it to read newer models"),
        ("0.0.1", "the model is of SimuLearn 0.0.1, this is .*: train the model again"),
    ],
)
def test_the_card_of_another_version_says_so(saved, version, words):
    for changes in ({"licence": "MIT"}, {"kind": "oracle"}, {"ranges": {}}):
        edit(saved, version=version, **changes)
        with pytest.raises(InputError, match=words):
            bundle_of(saved.path)


@pytest.mark.parametrize("change", ["shape", "missing", "more", "infinite"])
def test_arrays_that_do_not_fit_are_named(saved, change):
    import hashlib

    file = saved.path / "weights.safetensors"
    arrays = load_file(file)
    name = "release.first.joint.biases.0"
    if change == "shape":
        arrays[name] = arrays[name][:-1].copy()
    elif change == "missing":
        del arrays[name]
    elif change == "more":
        arrays["surplus"] = np.zeros(1)
    else:
        arrays[name] = np.full_like(arrays[name], np.inf)
    save_file(arrays, file)
    edit(saved, weights=hashlib.sha256(file.read_bytes()).hexdigest())
    with pytest.raises(InputError, match="surplus" if change == "more" else name):
        _ = bundle_of(saved.path).model


def test_an_architecture_that_is_none_is_reported(saved):
    card = bundle_of(saved.path).card
    wrong = {**card.architecture, "release": {"hidden": [3]}}
    edit(saved, architecture=wrong)
    with pytest.raises(InputError, match="architecture of release"):
        _ = bundle_of(saved.path).model


def test_default_is_the_first_of_those_that_are_there(saved, monkeypatch):
    monkeypatch.setattr(bundles, "BUNDLES", saved.path.parent)
    monkeypatch.setattr(bundles, "DEFAULTS", ("absent", "tiny"))
    assert bundle_of("default").card.name == "tiny"
    assert bundle_of("tiny").path == saved.path
    monkeypatch.setattr(bundles, "DEFAULTS", ("absent",))
    with pytest.raises(InputError, match="nor one of default, tiny"):
        bundle_of("default")
