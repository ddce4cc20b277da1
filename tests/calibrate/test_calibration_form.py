"""The form: round trip, what a person may write, and what is refused with key and strip."""

import pytest

from simulearn.calibrate import Form, form_text, parse_form, read_form, write_form
from simulearn.calibrate.checks import blanks, check_values, signs_mended, without_outliers
from simulearn.calibrate.plate import records
from simulearn.errors import InputError
from simulearn.material import load_material

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


def test_what_a_person_writes():
    text = form_text(FORM).replace('measured = ""', "measured =")
    head, top = text.split("[strips.top]")
    top = top.replace('chord = ["", "", ""]', 'chord = [40, "40,5", " 39.9 "]')
    form = parse_form(head + "[strips.top]" + top)
    assert form.strips["top"].chord == (40.0, 40.5, 39.9)
    assert form.measured == ""


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('chord = ["", "", ""]', 'chord = ["", "5 cm", ""]', "strip top, chord of repeat 2: is "),
        ('chord = ["", "", ""]', 'chord = ["", -3, ""]', "strip top, chord of repeat 2"),
        ('chord = ["", "", ""]', 'chord = [true, "", ""]', "strip top, chord of repeat 1"),
        ('chord = ["", "", ""]', 'chord = ["", ""]', "strip top: before has 3 values and chord 2"),
        ('chord = ["", "", ""]', "", "strip top, chord: Field required"),
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
        ("chord", 4.1, "seems to be in cm; write 41"),
        ("before", 4.72, "seems to be in cm; write 47.2"),
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
