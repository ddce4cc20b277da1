"""The project as people get it: its two files, installed far from the checkout.

What is installed is what requirements.lock pins, so that it comes from uv's cache.
"""

import shutil
import subprocess

import pytest

from installing import PATIENCE, ROOT, Installed
from requiring import required


@pytest.fixture(scope="session")
def uv():
    """Return a function that runs uv, from its cache where that has all that is needed."""
    program = shutil.which("uv") or shutil.which("uv", path=str(ROOT / ".venv-uv/bin"))
    required("uv", program is not None)

    def uv(*words, cwd=ROOT):
        done = None
        for offline in (["--offline"], []):
            done = subprocess.run(
                [program, "--quiet", *map(str, words), *offline],
                cwd=cwd, capture_output=True, text=True, timeout=PATIENCE,
            )  # fmt: skip
            if done.returncode == 0:
                return
        required("uv", "error sending request" not in done.stderr)  # no network, and not cached
        pytest.fail(done.stderr)

    return uv


@pytest.fixture(scope="session")
def built(uv, tmp_path_factory):
    """The folder of the two files that are uploaded: a wheel, made of the sdist."""
    folder = tmp_path_factory.mktemp("dist")
    uv("build", "--out-dir", folder, ROOT)
    return folder


@pytest.fixture(scope="session")
def wheel(built):
    (path,) = built.glob("*.whl")
    return path


@pytest.fixture(scope="session")
def sdist(built):
    (path,) = built.glob("*.tar.gz")
    return path


@pytest.fixture(scope="session")
def install(uv, wheel, tmp_path_factory):
    """Return a function that gives an environment with the wheel for a Python."""

    def install(python):
        place = tmp_path_factory.mktemp("elsewhere")
        uv("venv", "--python", python, place / "env", cwd=place)
        return Installed(place, uv, wheel)

    return install
