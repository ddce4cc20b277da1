"""Programs of others that read what SimuLearn writes."""

import json
import shutil
import subprocess
from pathlib import Path

import platformdirs
import pytest

from requiring import required

VALIDATOR = "gltf-validator@2.0.0-dev.3.10"  # of Khronos, from npm
SCRIPT = """
const [module, file] = process.argv.slice(1);
require(module).validateBytes(new Uint8Array(require("fs").readFileSync(file)))
  .then((report) => console.log(JSON.stringify(report.issues)));
"""


@pytest.fixture(scope="session")
def validated():
    """Return a function that gives what Khronos' validator says about a glTF file.

    The validator is installed into the cache of the tests where it is not there yet.
    """
    node, npm = shutil.which("node"), shutil.which("npm")
    folder = Path(platformdirs.user_cache_dir("simulearn-tests", appauthor=False)) / "gltf"
    module = folder / "node_modules" / "gltf-validator"
    if npm is not None and not module.is_dir():
        folder.mkdir(parents=True, exist_ok=True)
        command = [npm, "install", "--silent", "--no-audit", "--prefix", str(folder), VALIDATOR]
        subprocess.run(command, check=False, capture_output=True, timeout=300)
    required("gltf-validator", node is not None and module.is_dir())

    def validated(path):
        command = [node, "-e", SCRIPT, str(module), str(path)]
        done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=60)
        return json.loads(done.stdout)

    return validated


@pytest.fixture(scope="session")
def ffmpeg():
    """The program ffmpeg, or a skipped test."""
    found = shutil.which("ffmpeg")
    required("ffmpeg", found is not None)
    return found


@pytest.fixture
def page(visit):
    """A page of a headless Chromium."""
    return visit(viewport={"width": 800, "height": 600})
