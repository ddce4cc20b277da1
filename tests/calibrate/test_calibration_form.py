"""The form: round trip, what a person may write, and what is refused with key and strip."""

import pytest

from simulearn.calibrate import Form, form_text, parse_form, read_form, write_form
from simulearn.calibrate.checks import (
    blanks,
    check_section,
    check_values,
    signs_mended,
    without_outliers,
)
from simulearn.calibrate.form import CaliperSection
from simulearn.calibrate.plate import records
from simulearn.errors import InputError
from simulearn.material import load_material, material_text

BASE = load_material("pla-hot-water")
FORM = Form(printer='a "quoted" \\ one', strips=records(BASE, 3))


def with_row(key, row, strip="top"):
    form = FORM
    for k, value in enumerate(row):
        form = form.with_reading(strip, k, **{key: value})
    return form


def test_round_trip(tmp_path):
    form = with_row("chord", [40.1, None, 39.9]).with_reading("half", 1, photo="half 2.jpg")
    assert parse_form(form_text(form)) == form
    write_form(form, tmp_path / "form.toml")
    assert read_form(tmp_path / "form.toml") == form


def test_a_base_is_found_from_the_form(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plates").mkdir()
    (tmp_path / "base.toml").write_text(material_text("pla-hot-water"))
    file = tmp_path / "plates" / "form.toml"
    write_form(FORM.model_copy(update={"material": "base.toml"}), file)
    assert 'material = "../base.toml"' in file.read_text()
    monkeypatch.chdir("/")
    assert load_material(read_form(file).material) == BASE


def test_what_a_person_writes():
    text = form_text(FORM).replace('measured = ""', "measured =")
    head, top = text.split("[strips.top]")
    top = top.replace('rise = ["", "", ""]', 'rise = [, , "−.3in"]')
    top = top.replace('chord = ["", "", ""]', 'chord = [40, "40,5 mm", \'1.575"\']')
    form = parse_form(head + "[strips.top]" + top)
    assert form.strips["top"].chord == (40.0, 40.5, 40.005)
    assert form.strips["top"].rise == (None, None, -7.62)
    assert form.measured == ""


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('chord = ["", "", ""]', 'chord = ["", "5 km", ""]', "strip top, chord of repeat 2 is "),
        ('chord = ["", "", ""]', 'chord = ["", "gone", ""]', '"" where nothing was measured'),
        ('chord = ["", "", ""]', 'chord = ["", -3, ""]', "chord and rise changed places"),
        ('chord = ["", "", ""]', 'chord = [true, "", ""]', "strip top, chord of repeat 1 is True"),
        ('chord = ["", "", ""]', 'chord = [nan, "", ""]', "strip top, chord of repeat 1 is nan"),
        ('chord = ["", "", ""]', "chord = [40,1, 40,2, 40,3]", "decimals have a point"),
        ('chord = ["", "", ""]', 'chord = ["", ""]', "strip top: before has 3 values and chord 2"),
        ('chord = ["", "", ""]', "", "strip top, chord is missing"),
        ('chord = ["", "", ""]', 'cord = ["", "", ""]', "strip top, "),
        ('chord = ["", "", ""]', 'chord = ["", "" ""]', "is not valid TOML"),
    ],
)
def test_bad_forms(old, new, says):
    head, top = form_text(FORM).split("[strips.top]")
    with pytest.raises(InputError, match=r"my\.toml: ") as caught:
        parse_form(head + "[strips.top]" + top.replace(old, new), "my.toml")
    assert says in str(caught.value)
    assert caught.value.code == "calibration-form"


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        ("chord", 4.1, "seems to be in centimetres; write 41"),
        ("before", 4.72, "seems to be in centimetres; write 47.2"),
        ("chord", 1.6, "seems to be in inches; write 40.64"),
        ("before", 1.86, "seems to be in inches"),
        ("before", 57.2, "is the strip another one?"),
        ("chord", 52.0, "a chord is shorter than its strip"),
        ("rise", 40.0, "rises at most"),
    ],
)
def test_impossible_values(key, value, says):
    with pytest.raises(InputError, match=f"strip top, {key} of repeat 2 is") as caught:
        check_values(FORM.with_reading("top", 1, **{key: value}), BASE.section.width)
    assert says in str(caught.value)
    assert caught.value.code == "calibration-value"


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"chord": 7.4, "rise": 39.7}, "have chord and rise changed places"),
        ({"chord": 4.1, "rise": 7.4}, "other repeats have 40.2; is a digit or the decimal point"),
        ({"chord": 402.0, "rise": 7.4}, "other repeats have 40.2; is a digit or the decimal point"),
    ],
)
def test_what_an_impossible_value_may_be(values, says):
    form = FORM.with_reading("top", 0, chord=40.2, rise=7.3).with_reading("top", 1, **values)
    with pytest.raises(InputError) as caught:
        check_values(form, BASE.section.width)
    assert says in str(caught.value)


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        ("thickness", 0.4, "in centimetres"),
        ("width", 0.28, "in inches"),
        ("width", 4.0, "another material"),
    ],
)
def test_a_section_that_was_not_printed(key, value, says):
    form = FORM.model_copy(update={"section": CaliperSection(**{key: value})})
    with pytest.raises(InputError, match=says) as caught:
        check_section(form, BASE.section)
    assert (caught.value.code, caught.value.where) == ("calibration-value", f"section.{key}")


def test_what_is_no_form():
    with pytest.raises(InputError, match="is no form of a calibration"):
        parse_form(material_text("pla-hot-water"), "mine.toml")


def test_possible_values_pass():
    form = FORM.with_reading("top", 0, before=47.0, chord=39.7, rise=7.4)
    check_values(form.with_reading("long", 0, chord=100.0, rise=-60.0), BASE.section.width)


def test_wrong_sign_is_mended_and_said():
    form, said = signs_mended(FORM.with_reading("bottom", 2, rise=9.0))
    assert form.strips["bottom"].rise[2] == -9.0
    assert [m.code for m in said] == ["calibration-sign"]
    # What has no actuator may bend either way.
    form, said = signs_mended(FORM.with_reading("plain", 0, rise=9.0))
    assert form.strips["plain"].rise[0] == 9.0
    assert not said


def test_outlier_is_left_out_and_said():
    form = with_row("chord", [40.0, 40.4, 47.0])
    form, said = without_outliers(form)
    assert form.strips["top"].chord == (40.0, 40.4, None)
    assert [(m.code, m.where) for m in said] == [
        ("calibration-outlier", "strip top, chord of repeat 3")
    ]
    assert without_outliers(with_row("chord", [40.0, 40.4, 41.0]))[1] == []


def test_blanks_are_said():
    said = {m.where: m.message for m in blanks(with_row("chord", [40.0, None, 41.0]))}
    assert "chord of repeat 2" in said["strip top"]
    assert "has no values" in said["strip long"]
