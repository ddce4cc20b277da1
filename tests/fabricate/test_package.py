"""Packages for Bambu Lab printers: what is in them, their bytes, and who gets none."""

import hashlib
import io
import json
import sys
import xml.etree.ElementTree as ET
import zipfile

import pytest
from PIL import Image
from several import job_of

import simulearn.cli.fabricate  # noqa: F401  (adds its commands)
from simulearn import cli
from simulearn.errors import InputError
from simulearn.fabricate import load_printer, model_number, prepare, write_package
from simulearn.grid import make

PICTURES = {
    "plate_1": 512,
    "plate_no_light_1": 512,
    "plate_1_small": 128,
    "top_1": 512,
    "pick_1": 512,
}


@pytest.fixture
def package(tmp_path):
    write_package(job_of("bambu-x1", "two"), tmp_path / "two.gcode.3mf")
    with zipfile.ZipFile(tmp_path / "two.gcode.3mf") as file:
        assert file.testzip() is None
        return {name: file.read(name) for name in file.namelist()}


def test_the_print_is_in_it_with_its_checksum(package):
    job = job_of("bambu-x1", "two")
    assert package["Metadata/plate_1.gcode"] == job.gcode.encode()
    checksum = hashlib.md5(job.gcode.encode()).hexdigest().upper()
    assert package["Metadata/plate_1.gcode.md5"] == checksum.encode()


def test_all_that_is_named_is_there(package):
    for name, contents in package.items():
        if name.endswith((".rels", ".xml", ".model")) or (
            name.endswith("_settings.config") and (contents.startswith(b"<?xml"))
        ):
            root = ET.fromstring(contents)
            for element in root.iter():
                target = element.get("Target")
                assert target is None or target.removeprefix("/") in package
                if element.get("key", "").endswith("_file"):
                    assert element.get("value") in package
    kinds = {e.get("Extension") for e in ET.fromstring(package["[Content_Types].xml"])}
    assert kinds == {"rels", "model", "png", "gcode"}


def test_lists_say_what_the_print_takes(package):
    job = job_of("bambu-x1", "two")
    plate = ET.fromstring(package["Metadata/slice_info.config"]).find("plate")
    facts = {e.get("key"): e.get("value") for e in plate.findall("metadata")}
    whole = job.estimate.seconds + job.estimate.heating_seconds
    assert float(facts["prediction"]) == pytest.approx(whole, abs=1)
    assert float(facts["weight"]) == pytest.approx(job.estimate.filament_g, abs=0.01)
    assert facts["printer_model_id"] == "BL-P002"
    assert [e.get("name") for e in plate.findall("object")] == ["a_dome_1", "A_dome_1_2"]
    (filament,) = plate.findall("filament")
    assert filament.get("type") == "PLA"
    assert float(filament.get("used_m")) == pytest.approx(job.estimate.filament_mm / 1000, abs=0.01)
    data = json.loads(package["Metadata/plate_1.json"])
    boxes = [each["bbox"] for each in data["bbox_objects"]]
    assert data["bbox_all"] == [
        *(min(box[k] for box in boxes) for k in (0, 1)),
        *(max(box[k] for box in boxes) for k in (2, 3)),
    ]
    assert boxes[0][2] < boxes[1][0] or boxes[1][2] < boxes[0][0] or boxes[0][3] < boxes[1][1]
    assert (
        json.loads(package["Metadata/project_settings.config"])["printer_model"] == "Bambu Lab X1"
    )


def test_pictures_have_their_sizes(package):
    for name, side in (PICTURES | {"plate_1_small": 128}).items():
        with Image.open(io.BytesIO(package[f"Metadata/{name}.png"])) as picture:
            assert (picture.format, picture.size) == ("PNG", (side, side))


def test_the_same_print_gives_the_same_bytes(tmp_path):
    contents = set()
    for k in range(2):
        job = prepare([make("dome", (1, 1), 30.0)], load_printer("bambu-x1"), ["dome"])
        write_package(job, tmp_path / f"{k}.gcode.3mf")
        contents.add((tmp_path / f"{k}.gcode.3mf").read_bytes())
    assert len(contents) == 1


def test_models_are_known_by_their_titles():
    x1 = load_printer("bambu-x1")
    titles = {
        "Bambu Lab X1": "BL-P002",
        "bambu lab x1 carbon": "BL-P001",
        "Bambu Lab A1 mini (upstairs)": "N1",
        "Bambu Lab A1": "N2S",
        "Bambu Lab P1S": "C12",
    }
    for title, number in titles.items():
        assert model_number(x1.model_copy(update={"title": title})) == number
    with pytest.raises(InputError, match="must name the model: Bambu Lab X1 Carbon"):
        model_number(x1.model_copy(update={"title": "The one upstairs"}))


def test_other_printers_get_none(tmp_path, monkeypatch, capsys):
    with pytest.raises(InputError, match="voron is not a Bambu Lab printer"):
        write_package(job_of("voron", "two"), tmp_path / "a.gcode.3mf")
    path = tmp_path / "b.gcode.3mf"
    monkeypatch.setattr(
        sys, "argv", ["simulearn", "gcode", "dome", "--printer", "voron", "-o", str(path)]
    )
    with pytest.raises(SystemExit) as stop:
        cli.main()
    assert stop.value.code == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "b.gcode.3mf: voron is not a Bambu Lab printer; it reads .gcode" in line
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_one(tmp_path, monkeypatch, capsys):
    profile, path = tmp_path / "mine.toml", tmp_path / "DOME.GCODE.3MF"
    profile.write_text('base = "bambu-x1"\nfirmware = "bambu"\n')
    monkeypatch.setattr(
        sys, "argv", ["simulearn", "gcode", "dome", "--printer", str(profile), "-o", str(path)]
    )
    with pytest.raises(SystemExit) as stop:
        cli.main()
    assert not stop.value.code
    assert str(path) in capsys.readouterr().out.replace("\n", "")
    with zipfile.ZipFile(path) as file:
        assert b"; HEADER_BLOCK_START" in file.read("Metadata/plate_1.gcode")[:30]
