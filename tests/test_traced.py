"""Traces kept between runs."""

import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import jax
import numpy as np
import pytest

from simulearn import traced
from simulearn.traced import Traced

NUMBERS = np.arange(3.0)


@pytest.fixture
def kept(tmp_path: Path) -> Iterator[Path]:
    """Yield the folder of traces, of this test only."""
    before = jax.config.values["jax_compilation_cache_dir"]
    jax.config.update("jax_compilation_cache_dir", str(tmp_path))
    yield tmp_path / "traced"
    jax.config.update("jax_compilation_cache_dir", before)


def twice(x: dict[str, jax.Array]) -> tuple[jax.Array, None]:
    return 2 * x["a"], None


def never(*args: object) -> None:
    raise AssertionError("was traced again")


def test_a_second_run_does_not_trace_again(kept: Path) -> None:
    first = Traced("twice", twice)({"a": NUMBERS})
    again = Traced("twice", never)({"a": NUMBERS})
    assert first[1] is None
    assert again[1] is None
    np.testing.assert_array_equal(first[0], 2 * NUMBERS)
    np.testing.assert_array_equal(again[0], 2 * NUMBERS)
    assert len(list(kept.iterdir())) == 1


def test_other_shapes_names_and_sources_are_other_traces(
    kept: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    call = Traced("twice", twice)
    for x in (NUMBERS, NUMBERS[:2], NUMBERS.astype(np.float32)):
        np.testing.assert_array_equal(call({"a": x})[0], 2 * x)
    assert len(list(kept.iterdir())) == 3
    with pytest.raises(AssertionError, match="traced again"):
        Traced("thrice", never)({"a": NUMBERS})
    monkeypatch.setattr(traced, "SOURCE", "changed")
    with pytest.raises(AssertionError, match="traced again"):
        Traced("twice", never)({"a": NUMBERS})


def bit_flipped(whole: bytes) -> bytes:
    k = len(whole) // 2
    return whole[:k] + bytes([whole[k] ^ 1]) + whole[k + 1 :]


@pytest.mark.parametrize(
    "damaged", [lambda _: b"", lambda _: b"nonsense", lambda w: w[: len(w) // 2], bit_flipped]
)
def test_a_damaged_trace_is_made_anew(kept: Path, damaged: Callable[[bytes], bytes]) -> None:
    Traced("twice", twice)({"a": NUMBERS})
    (file,) = kept.iterdir()
    file.write_bytes(damaged(file.read_bytes()))
    np.testing.assert_array_equal(Traced("twice", twice)({"a": NUMBERS})[0], 2 * NUMBERS)
    Traced("twice", never)({"a": NUMBERS})


def test_where_nothing_can_be_kept_it_is_traced(kept: Path) -> None:
    kept.write_text("in the way")
    np.testing.assert_array_equal(Traced("twice", twice)({"a": NUMBERS})[0], 2 * NUMBERS)
    jax.config.update("jax_compilation_cache_dir", None)
    np.testing.assert_array_equal(Traced("twice", twice)({"a": NUMBERS})[0], 2 * NUMBERS)


def test_threads_that_ask_at_once_compile_once(kept: Path) -> None:
    traces = []

    def slow(x: dict[str, jax.Array]) -> jax.Array:
        traces.append(1)
        time.sleep(0.3)
        return 3 * x["a"]

    call = Traced("slow", slow)
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda k: call({"a": NUMBERS + k}), range(4)))
    assert len(traces) == 1
    for k, x in enumerate(found):
        np.testing.assert_array_equal(x, 3 * (NUMBERS + k))
