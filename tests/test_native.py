"""Native kernels are compiled once, found again by the contents of their source, and shared."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

KERNELS = """
from simulearn.native import native

@native(entry=False)
def factor():
    return {factor}

@native()
def times(x):
    return factor() * x
"""
RUN = """
import numba
from pack.kernels import times
from simulearn.native import on_compile

compiled = []
with on_compile(lambda: compiled.append(True)):
    value = times(21.0)
print(value, len(compiled), numba.config.CACHE_DIR or "unset")
"""


def folder_of(tmp_path: Path, factor: float) -> Path:
    pack = tmp_path / "pack"
    pack.mkdir(exist_ok=True)
    (pack / "__init__.py").write_text("", "utf-8")
    (pack / "kernels.py").write_text(KERNELS.format(factor=factor), "utf-8")
    return tmp_path


def begun(folder: Path, cache: Path) -> subprocess.Popen[str]:
    env = {**os.environ, "XDG_CACHE_HOME": str(cache), "PYTHONDONTWRITEBYTECODE": "1"}
    path = os.pathsep.join([str(folder), *(p for p in sys.path if p)])
    return subprocess.Popen(
        [sys.executable, "-W", "error", "-c", RUN],
        env={**env, "PYTHONPATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def ended(process: subprocess.Popen[str]) -> list[str]:
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    return out.split()


linux = pytest.mark.skipif(sys.platform != "linux", reason="the cache folder is named by XDG")


@linux
def test_two_processes_share_an_empty_cache(tmp_path):
    folder, cache = folder_of(tmp_path, 2.0), tmp_path / "cache"
    cache.mkdir()
    both = [begun(folder, cache) for _ in range(2)]
    assert [ended(process)[0] for process in both] == ["42.0", "42.0"]
    assert ended(begun(folder, cache)) == ["42.0", "0", "unset"]  # the third compiles nothing


@linux
def test_equal_sources_share_their_kernels_wherever_they_lie(tmp_path):
    """As a checkout, an installed package and its next version in another environment do."""
    cache, here, there = tmp_path / "cache", tmp_path / "here", tmp_path / "there"
    for folder in (cache, here, there):
        folder.mkdir()
    assert ended(begun(folder_of(here, 2.0), cache)) == ["42.0", "1", "unset"]
    assert ended(begun(folder_of(there, 2.0), cache)) == ["42.0", "0", "unset"]


@linux
def test_an_edited_kernel_is_another_one(tmp_path):
    cache = tmp_path / "cache"
    cache.mkdir()
    assert ended(begun(folder_of(tmp_path, 2.0), cache)) == ["42.0", "1", "unset"]
    assert ended(begun(folder_of(tmp_path, 3.0), cache)) == ["63.0", "1", "unset"]
    assert ended(begun(folder_of(tmp_path, 2.0), cache))[0] == "42.0"


@linux
def test_without_a_folder_for_the_cache_kernels_work(tmp_path):
    blocked = tmp_path / "blocked"
    blocked.write_text("a file where a folder should be", "utf-8")
    assert ended(begun(folder_of(tmp_path, 2.0), blocked)) == ["42.0", "1", "unset"]


@linux
@pytest.mark.parametrize("ending", [".nbi", ".nbc"])
def test_a_torn_kernel_is_compiled_anew_and_kept(tmp_path, ending):
    folder, cache = folder_of(tmp_path, 2.0), tmp_path / "cache"
    cache.mkdir()
    assert ended(begun(folder, cache)) == ["42.0", "1", "unset"]
    for file in cache.rglob(f"*{ending}"):
        file.write_bytes(file.read_bytes()[:100])
    assert ended(begun(folder, cache)) == ["42.0", "1", "unset"]
    assert ended(begun(folder, cache)) == ["42.0", "0", "unset"]


def test_a_disk_without_room_keeps_no_kernel(tmp_path, monkeypatch):
    import errno

    from numba.core.caching import IndexDataCacheFile

    from simulearn import native

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(native, "_folder", lambda source: tmp_path)
    monkeypatch.setattr(IndexDataCacheFile, "save", full)

    @native.native()
    def twice(x):
        return 2 * x

    assert twice(21.0) == 42.0
    assert not list(tmp_path.rglob("*.nb?"))
