"""What is in the wheel and the sdist, and what an index shows of them."""

import email
import hashlib
import re
import tarfile
import tomllib
import zipfile

import pytest

from installing import ROOT
from simulearn import __version__
from simulearn.extras import EXTRAS

SOURCE = "https://example.org/someone/simulearn"
ENDINGS = {"py", "typed", "toml", "json", "safetensors", "html", "css", "js", "svg", "png"}


def metadata(wheel):
    with zipfile.ZipFile(wheel) as file:
        (name,) = (n for n in file.namelist() if n.endswith(".dist-info/METADATA"))
        return email.message_from_bytes(file.read(name))


def test_the_wheel_holds_the_package_and_nothing_else(wheel):
    files = [
        path
        for path in (ROOT / "src").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    ]
    ours = {path.relative_to(ROOT / "src").as_posix() for path in files}
    with zipfile.ZipFile(wheel) as file:
        inside = {name for name in file.namelist() if ".dist-info/" not in name}
    assert inside == ours
    assert {name.rpartition(".")[2] for name in inside} <= ENDINGS
    assert {name.partition("/")[0] for name in inside} == {"simulearn"}


def test_the_sdist_makes_the_same_wheel_as_the_checkout(uv, wheel, tmp_path):
    uv("build", "--wheel", "--out-dir", tmp_path, ROOT)
    digests = {hashlib.sha256(p.read_bytes()).digest() for p in (wheel, *tmp_path.glob("*.whl"))}
    assert len(digests) == 1


def test_the_sdist_holds_what_its_tests_need_and_no_data(sdist):
    with tarfile.open(sdist) as file:
        names = {name.partition("/")[2] for name in file.getnames()}
    assert {"LICENSE", "README.md", "pyproject.toml", "requirements.lock"} <= names
    assert {"tests/conftest.py", "tests/packages/conftest.py", "benchmarks/browsing.py"} <= names
    assert {name.partition("/")[0] for name in names} <= {
        *("LICENSE", "README.md", "CHANGELOG.md", "CITATION.cff", "PKG-INFO", "Makefile"),
        *("Containerfile", "pyproject.toml", "requirements.lock", "hatch_build.py", "mkdocs.yml"),
        *(".ci", ".gitignore", ".pre-commit-config.yaml"),
        *("src", "tests", "benchmarks", "examples", "docs"),
    }


def test_the_version_stands_in_one_place(wheel):
    assert metadata(wheel)["Version"] == __version__
    assert f"\nversion: {__version__}\n" in (ROOT / "CITATION.cff").read_text("utf-8")


def test_every_optional_package_is_in_the_extra_that_messages_name():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    for package, extra in EXTRAS.items():
        text = " ".join(extras[extra])
        named = re.findall(r"[\w-]+", text)
        name = {"cv2": "opencv-python-headless"}.get(package, package)
        assert name in named, f"{package} in {extra}: {text}"


def page(wheel):
    return metadata(wheel).get_payload()


def test_without_an_address_the_page_has_no_dead_picture_or_link(wheel):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    if "Source" in project.get("urls", {}):
        pytest.skip("the address of the repository is known")
    assert "<img" not in page(wheel)
    assert re.findall(r"\]\((?!https?:)", page(wheel)) == []
    assert "(http://www.calculix.de)" in page(wheel)


def test_with_an_address_every_picture_and_link_is_absolute(uv, sdist, tmp_path):
    with tarfile.open(sdist) as file:
        file.extractall(tmp_path, filter="data")
    (project,) = (path for path in tmp_path.iterdir() if path.is_dir())
    (project / "PKG-INFO").unlink()  # so that the page is made anew
    pyproject = project / "pyproject.toml"
    text = re.sub(r"\n\[project\.urls\]\n(?:.+\n)+", "\n", pyproject.read_text("utf-8"))
    pyproject.write_text(f'{text}\n[project.urls]\nSource = "{SOURCE}/"\n', "utf-8")
    uv("build", "--wheel", "--out-dir", tmp_path, project)
    (wheel,) = tmp_path.glob("*.whl")
    readme = (ROOT / "README.md").read_text("utf-8")
    pictures = re.findall(r'<img src="([^"]+)"', readme)
    assert pictures
    shown = re.findall(r'<img src="([^"]+)"', page(wheel))
    assert shown == [f"{SOURCE}/raw/v{__version__}/{picture}" for picture in pictures]
    if (ROOT / "docs/pictures").is_dir():  # the sdist is without them
        assert all((ROOT / picture).is_file() for picture in pictures)
    places = re.findall(rf"\]\({SOURCE}/blob/v{__version__}/([^)#]+)", page(wheel))
    assert places
    assert all((ROOT / place).exists() for place in places)
    assert re.findall(r"\]\((?!https?:)", page(wheel)) == []
