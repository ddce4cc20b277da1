"""Strips measured in photos: drawn photos with known answers, and what must be refused."""

import tomllib
from dataclasses import replace
from functools import lru_cache

import cv2
import numpy as np
import pytest
import typer
from PIL import Image
from typer.testing import CliRunner

from simulearn import extras
from simulearn.calibrate.photo import measure_photo
from simulearn.calibrate.photo_camera import Camera, fit_camera
from simulearn.calibrate.photo_file import read_photo
from simulearn.calibrate.photo_form import FormText
from simulearn.calibrate.photo_markers import find_markers
from simulearn.calibrate.photo_sheet import marker_corners, printed_size
from simulearn.calibrate.photo_strip import KNOTS, _derivatives, _residuals, fit_curve
from simulearn.cli.calibrate_photo import register
from simulearn.errors import InputError
from simulearn.material import load_material, material_text
from simulearn.show.photo_sheet import photo_sheet
from strip_photos import RULER, Lamp, Lens, Scene, Strip, measures, save

SECTION = load_material("pla-hot-water").section
LENS = Lens(distance=330, size=(1200, 900))
SCENE = Scene(lens=LENS)

FORM = """\
format = "simulearn-calibration/1"
measured = "by hand"   # a note, with [brackets]

[section]
thickness = "4,1"
width =

[strips.top]   # T1, T2
beams = [60.0]
actuators = [1.0]
before = [66.9, ""]
chord = ["", ""]   # between the tips
rise = [ "", '' ]

[strips.plain]
beams = [70.0]
actuators = [0.0]
before = [77.0]
chord = [""]
rise = [""]
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("photos")


@pytest.fixture(scope="module")
def photo(folder):
    """Return a function that gives the photo of a scene; each is drawn once."""

    @lru_cache
    def drawn(scene, exif=True):
        return save(scene, folder / f"{hash((scene, exif))}.jpg", exif=exif)

    return drawn


@pytest.fixture
def commands():
    """Return a function that runs a command and returns what it printed."""
    app = typer.Typer()
    register(app)

    def run(*words):
        result = CliRunner().invoke(app, list(map(str, words)))
        if result.exception is not None:
            raise result.exception
        return result.output

    return run


def off(result, strip):
    """Return the errors of chord and rise, mm."""
    chord, rise = strip.measures()
    return result.measures.chord - chord, result.measures.rise - rise


def code_of(path, **options):
    with pytest.raises(InputError) as refused:
        measure_photo(path, SECTION, **options)
    return refused.value.code


def test_the_command_measures_draws_and_fills_in_the_form(photo, commands, folder):
    strip = Strip(heading=20.0)
    path = photo(replace(SCENE, strips=(strip,), note=True, lens=replace(LENS, tilt=14.0)))
    form, picture = folder / "form.toml", folder / "found.png"
    form.write_text(FORM, encoding="utf-8")
    said = commands("photo", path, "-o", picture, "--form", form, "--strip", "top", "--repeat", 2)
    assert "8 of 8 markers" in said
    assert "sign is that of its actuators in the top half" in said
    values = tomllib.loads(form.read_text(encoding="utf-8").replace("width =", "width = 0"))
    chord, rise = strip.measures()
    assert values["strips"]["top"]["chord"] == ["", pytest.approx(chord, abs=0.4)]
    assert values["strips"]["top"]["rise"] == ["", pytest.approx(rise, abs=0.3)]
    written = form.read_text(encoding="utf-8")
    for line in set(FORM.splitlines()) - {"rise = [ \"\", '' ]"}:
        assert line.startswith("chord") or line in written
    assert "   # between the tips" in written
    with Image.open(picture) as image:
        assert image.width > 1000


def test_a_rise_has_the_sign_of_the_side_that_was_up(photo):
    path = photo(SCENE)
    assert measure_photo(path, SECTION).sign is None
    signs = {up: measure_photo(path, SECTION, up=up).sign for up in ("inside", "outside", "arrow")}
    # The strip turns left from heading +x: its hollow side faces up and left, away from the arrow.
    assert signs == {"inside": 1, "outside": -1, "arrow": -1}
    assert code_of(path, up="above") == "photo-up"


def test_white_strips_need_the_dark_sheet(photo):
    white = replace(SCENE, colour="white")
    assert code_of(photo(white)) == "photo-no-strip"
    result = measure_photo(photo(replace(white, dark=True)), SECTION)
    assert np.abs(off(result, SCENE.strips[0])).max() < 0.4


def test_a_scale_measures_without_the_sheet(photo):
    scene = replace(SCENE, sheet=False, colour="blue", lens=replace(LENS, tilt=0.5))
    ends = scene.lens.seen(np.array([[*end, 0.0] for end in RULER]))
    scale = ",".join(f"{value:.0f}" for value in ends.ravel()) + "=100"
    result = measure_photo(photo(scene), SECTION, scale=scale)
    assert np.abs(off(result, scene.strips[0])).max() < 1.0
    assert result.measures.chord_deviation > 0.3
    assert [message.code for message in result.messages] == ["photo-scale-only"]
    for wrong in ("1,2,3=4", "0,0,1,1=50", "0,0,9999,0=50", "0,0,900,0=1", "0,0,900,0=10000"):
        assert code_of(photo(scene), scale=wrong) == "photo-scale"
    for height in (np.nan, -1.0, 5000.0):
        assert code_of(photo(scene), scale=scale, scale_height=height) == "photo-scale"
    assert code_of(photo(scene)) == "photo-markers"


def test_what_cannot_be_measured_is_refused(photo):
    two = (replace(Strip(), place=(70.0, 90.0)), replace(Strip(), place=(100.0, 160.0)))
    assert code_of(photo(replace(SCENE, strips=two))) == "photo-strips"
    touching = tuple(replace(Strip(), place=(50.0 + 30 * k, 60.0 + 40 * k)) for k in range(3))
    assert code_of(photo(replace(SCENE, strips=touching))) == "photo-strips"
    aside = (replace(Strip(), place=(30.0, 120.0)),)
    assert code_of(photo(replace(SCENE, strips=aside, lamps=()))) == "photo-edge"
    blurred = photo(replace(SCENE, blur=2.6))
    assert code_of(blurred) in ("photo-blurred", "photo-markers")


def test_some_markers_may_be_covered(photo):
    result = measure_photo(photo(replace(SCENE, cover=(0, 5))), SECTION)
    assert result.reference.markers == 6
    assert np.abs(off(result, SCENE.strips[0])).max() < 0.4
    with pytest.raises(InputError, match="3 only") as refused:
        measure_photo(photo(replace(SCENE, cover=(0, 2, 3, 5, 6))), SECTION)
    assert refused.value.code == "photo-markers"


def test_files_that_are_no_photos_are_refused(tmp_path):
    small, text, raw = (tmp_path / name for name in ("small.png", "text.jpg", "photo.heic"))
    Image.new("RGB", (300, 200)).save(small)
    text.write_text("no picture")
    raw.write_text("no picture")
    half = tmp_path / "half.png"
    half.write_bytes(small.read_bytes()[:60])
    assert code_of(small) == "photo-small"
    assert code_of(text) == code_of(half) == code_of(raw) == "photo-file"
    with pytest.raises(InputError, match="no such file"):
        measure_photo(tmp_path / "none.jpg", SECTION)
    with pytest.raises(InputError, match="JPEG"):
        measure_photo(raw, SECTION)


def test_pixels_of_16_bits_are_read(tmp_path):
    grey = np.full((600, 700), 100 * 257, np.uint16)
    Image.fromarray(grey).save(tmp_path / "grey.png")
    assert (read_photo(tmp_path / "grey.png").pixels == 100).all()
    Image.fromarray(grey.astype(np.float32)).save(tmp_path / "grey.tif")
    with pytest.raises(InputError, match="save a copy as JPEG"):
        read_photo(tmp_path / "grey.tif")
    Image.new("1", (14000, 14000)).save(tmp_path / "huge.png")
    with pytest.raises(InputError, match="million pixels"):
        read_photo(tmp_path / "huge.png")


def test_the_focal_length_and_crops_are_read_from_the_file(tmp_path):
    path = tmp_path / "photo.jpg"
    image = Image.new("RGB", (1600, 1200))
    tags = image.getexif()
    tags.get_ifd(0x8769).update({0xA405: 26, 0xA002: 1600, 0xA003: 1200})
    image.save(path, exif=tags)
    assert read_photo(path).focal == pytest.approx(26 / 43.27 * 2000)
    tags.get_ifd(0x8769)[0xA003] = 1600
    image.save(path, exif=tags)
    assert read_photo(path).cropped
    assert read_photo(path).focal is None


def test_photos_need_opencv(monkeypatch):
    monkeypatch.setattr(extras.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"simulearn\[photo\]"):
        measure_photo("photo.jpg", SECTION)


@pytest.mark.parametrize("paper", ["a4", "letter"])
@pytest.mark.parametrize("dark", [False, True])
def test_the_markers_of_the_page_are_where_they_should_be(tmp_path, paper, dark):
    path = tmp_path / "sheet.png"
    photo_sheet(paper, dark).savefig(path, dpi=127)
    photo = read_photo(path)
    found, is_dark = find_markers(photo)
    assert is_dark == dark
    assert sorted(found) == list(range(8))
    corner = found[0][3]
    for number, corners in found.items():
        on_page = (corners - corner) * [1, -1] / 5
        np.testing.assert_allclose(on_page, marker_corners(number), atol=0.15)


def test_the_sheet_is_written_in_its_true_size(commands, tmp_path):
    commands("sheet", "-o", tmp_path / "sheet.svg", "--paper", "letter")
    assert 'width="612pt"' in (tmp_path / "sheet.svg").read_text(encoding="utf-8")
    commands("sheet", "-o", tmp_path / "sheet.pdf")
    assert b"/MediaBox [ 0 0 595.27" in (tmp_path / "sheet.pdf").read_bytes()
    with pytest.raises(InputError, match="ending"):
        commands("sheet", "-o", tmp_path / "sheet.doc")
    assert printed_size("131.3,190") == (1.01, 1.0)
    for wrong in ("130", "13,19", "a,b"):
        with pytest.raises(InputError, match="130,190"):
            printed_size(wrong)


def test_a_camera_is_found_again_from_its_points():
    camera = Camera(
        np.array([2.9, 0.4, -0.2, -80, 110, 400, 0.1, 0.002, -0.003, 0.02]),
        (1600, 1200),
        1200.0,
        np.zeros((10, 10)),
    )
    places = np.concatenate([marker_corners(number) for number in range(8)])
    pixels = camera.pixels(np.column_stack([places, 0 * places[:, 0]]))
    found = fit_camera(places, pixels, camera.size, camera.focal_length)
    assert found.residual < 0.05
    for height in (0.0, 7.2):
        seen = camera.pixels(np.column_stack([places, np.full(len(places), height)]))
        np.testing.assert_allclose(camera.on_plane(seen, height), places, atol=1e-6)
        np.testing.assert_allclose(found.on_plane(seen, height), places, atol=0.05)


def test_a_curve_is_found_again_from_its_outline():
    strip = Strip(pieces=((20.0, 0.0), (35.0, -0.03), (22.2, 0.0)), heading=200.0)
    outline = strip.outline()
    outline += np.random.default_rng(0).normal(0, 0.03, outline.shape)
    curve = fit_curve(outline, strip.line(step=4.0), 3.6).curve
    assert curve.thickness == pytest.approx(4.0, abs=0.02)
    assert curve.length == pytest.approx(77.2, abs=0.1)
    np.testing.assert_allclose(
        measures(curve.beside(curve.hollow * 2.0)), strip.measures(), atol=0.1
    )


def test_derivatives_of_the_curve_are_those_of_its_residuals():
    bend = 0.03 + 0.01 * np.sin(np.arange(KNOTS))
    numbers = np.concatenate([[1.0, 2.0, 0.3, 50.0, 4.0], bend])
    points = Strip(thickness=4.6).outline()[::7]
    points = points - points[0] + [1.0, 0.1]
    table = _derivatives(numbers, points)
    for k, step in ((0, 1e-4), (2, 1e-5), (3, 1e-4), (4, 1e-4), (9, 1e-6)):
        ahead, behind = numbers.copy(), numbers.copy()
        ahead[k] += step
        behind[k] -= step
        slope = (_residuals(ahead, points) - _residuals(behind, points)) / (2 * step)
        assert np.median(np.abs(slope - table[:, k])) < 0.02 * np.abs(slope).max()


def test_a_form_that_cannot_be_changed_is_left_alone(tmp_path):
    path = tmp_path / "form.toml"
    path.write_text(FORM, encoding="utf-8")
    assert FormText(path, "plain", 1).expected_sign is None
    section = FormText(path, "top", 1).section(None)
    assert (section.thickness, section.width) == (4.1, 7.2)
    # The base of the form is what was printed.
    base = tmp_path / "base.toml"
    base.write_text(material_text("pla-hot-water").replace("width = 7.2", "width = 8.0"))
    path.write_text(FORM.replace("format", 'material = "base.toml"\nformat'), encoding="utf-8")
    assert FormText(path, "top", 1).section(None).width == 8.0
    assert FormText(path, "top", 1).section("pla-hot-water").width == 7.2
    for old, new in (("actuators = [1.0]", 'actuators = ["x"]'), ("width =", 'width = "?"')):
        path.write_text(FORM.replace(old, new), encoding="utf-8")
        with pytest.raises(InputError) as refused:
            FormText(path, "top", 1)
        assert refused.value.code == "calibration-form"
    path.write_text(FORM, encoding="utf-8")
    for strip, repeat in (("middle", 1), ("plain", 2)):
        with pytest.raises(InputError, match=r"repeats|no strip"):
            FormText(path, strip, repeat)
    odd = FORM.replace('chord = ["", ""]', 'chord = ["", # one\n ""]')
    path.write_text(odd, encoding="utf-8")
    with pytest.raises(InputError, match=r"write chord 31.20 and rise 4.00 .*by hand"):
        FormText(path, "top", 2).write({"chord": 31.2, "rise": 4.0})
    assert path.read_text(encoding="utf-8") == odd


def test_the_command_asks_for_the_sign_where_nothing_tells_it(photo, commands, folder):
    form = folder / "plain.toml"
    form.write_text(FORM, encoding="utf-8")
    words = ["photo", photo(SCENE), "-o", folder / "plain.png", "--form", form]
    with pytest.raises(InputError, match="--up inside"):
        commands(*words, "--strip", "plain")
    assert form.read_text(encoding="utf-8") == FORM
    commands(*words, "--strip", "plain", "--up", "outside")
    assert FormText(form, "plain", 1).record["rise"][0] < -10
    with pytest.raises(InputError, match="belong together"):
        commands(*words)
    # A strip of another length is another strip.
    form.write_text(FORM.replace("[70.0]", "[110.0]"), encoding="utf-8")
    with pytest.raises(InputError, match="name the strip that it is"):
        commands(*words, "--strip", "plain", "--up", "outside")
    assert 'chord = [""]' in form.read_text(encoding="utf-8")
    for wrong in (("--length", "nan"), ("--length", "-3"), ("--scale-height", "2")):
        with pytest.raises(InputError, match=wrong[0]):
            commands(*words[:4], *wrong)


def test_shadows_are_not_the_strip(photo):
    lamp = Lamp(height=38.0, azimuth=250.0, half_angle=1.5, share=0.55)
    scene = replace(SCENE, colour="green", lamps=(lamp,))
    assert np.abs(off(measure_photo(photo(scene), SECTION), scene.strips[0])).max() < 0.4


def test_opencv_is_as_expected():
    assert hasattr(cv2.aruco, "ArucoDetector")
