"""Commands that measure strips in photos: photo, sheet."""

import json
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer
from rich.markup import escape

from simulearn.cli.base import Json, MaterialOption, err, out, print_files
from simulearn.errors import InputError
from simulearn.files import replacing
from simulearn.material import load_material

if TYPE_CHECKING:
    from simulearn.calibrate.photo import StripPhoto
    from simulearn.calibrate.photo_form import FormText

NOTES = ("photo-size", "photo-scale-only")  # what was taken; all else is a warning
SHEETS = (".pdf", ".svg", ".png")
PICTURES = (".png", ".jpg", ".jpeg", ".pdf", ".svg")
BATH = 0.02  # of a strip's length, by which a length given may differ from the photo's
DPI = 200


def register(calibrate: typer.Typer) -> None:
    """Add the commands to `simulearn calibrate`."""
    calibrate.command()(photo)
    calibrate.command()(sheet)


def photo(
    file: Annotated[Path, typer.Argument(metavar="PHOTO", help="JPEG or PNG, not cropped.")],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", help="The picture of what was found; PHOTO-found.png without it."
        ),
    ] = None,
    scale: Annotated[
        str | None,
        typer.Option(
            metavar="X1,Y1,X2,Y2=MM",
            help="Two points of a photo without the printed sheet, in pixels, and their distance.",
        ),
    ] = None,
    scale_height: Annotated[
        float, typer.Option(metavar="MM", help="How high over the table these points are.")
    ] = 0.0,
    printed: Annotated[
        str | None,
        typer.Option(
            metavar="ACROSS,ALONG", help="Measured size of the frame on the printed sheet, mm."
        ),
    ] = None,
    up: Annotated[
        Literal["inside", "outside", "arrow", "left", "right", "top", "bottom"] | None,
        typer.Option(
            help="Where the side is that was up in the printer: inside or outside of the curve, "
            "where the sheet's arrow points, or a side of the photo. It gives the rise its sign."
        ),
    ] = None,
    length: Annotated[
        float | None,
        typer.Option(metavar="MM", help="Length along the strip after the bath, as a check."),
    ] = None,
    material: MaterialOption = None,
    form: Annotated[
        Path | None, typer.Option(metavar="FORM", help="Write chord and rise into this form.")
    ] = None,
    strip: Annotated[
        str | None, typer.Option(metavar="NAME", help="Which strip of the form it is.")
    ] = None,
    repeat: Annotated[int, typer.Option(min=1, help="Which of its repeats.")] = 1,
    as_json: Json = False,
) -> None:
    """Measure chord and rise of a curled strip in a photo, and draw what was found over it."""
    from simulearn.calibrate.photo import measure_photo
    from simulearn.calibrate.photo_form import FormText

    picture = output or file.with_name(f"{file.stem}-found.png")
    _check_picture(picture, file)
    if length is not None and not 0 < length < inf:
        raise InputError(f"--length is {length:g}; it is a length in mm", "photo-length")
    if scale is None and scale_height:
        raise InputError("--scale-height goes with --scale: how high its points are", "photo-scale")
    if (form is None) != (strip is None):
        raise InputError("a form and the name of a strip in it belong together", "photo-form")
    text = FormText(form, strip, repeat) if form is not None and strip is not None else None
    name = str(material) if material else None
    section = text.section(name) if text else load_material(name or "pla-hot-water").section
    result = measure_photo(
        file,
        section,
        scale=scale,
        scale_height=scale_height,
        printed=printed,
        up=up,
    )
    _draw(result, picture)
    rise, why = _rise(result, text)
    if text is not None:
        text.check_length(result.curve.length, section.width)
        text.write({"chord": result.chord, "rise": rise})
    if as_json:
        files = [str(picture), *([str(form)] if form else [])]
        print(json.dumps(result.to_dict() | {"rise": round(rise, 4), "files": files}))
        return
    _print(result, rise, why)
    if length is not None and abs(result.curve.length - length) > BATH * length:
        _warn(
            f"the strip is {result.curve.length:.1f} mm long in the photo and {length:g} by your "
            "own measure; see in the picture whether its ends are right"
        )
    print_files([picture, *([form] if form else [])])


def sheet(
    output: Annotated[
        Path, typer.Option("-o", "--output", help="The page to print (.pdf, .svg, .png).")
    ],
    paper: Annotated[Literal["a4", "letter"], typer.Option(help="Its size.")] = "a4",
    dark: Annotated[
        bool, typer.Option("--dark", help="With a dark inside, for white and other light strips.")
    ] = False,
) -> None:
    """Make the page on which strips are photographed: print it in its true size."""
    from simulearn.show.photo_sheet import photo_sheet

    ending = output.suffix.lower()
    if ending not in SHEETS:
        raise InputError(f"{output}: the ending is not one of {' '.join(SHEETS)}")
    figure = photo_sheet(paper, dark)
    with replacing(output) as temporary:
        figure.savefig(temporary, dpi=300, metadata=None if ending == ".png" else _undated(ending))
    out.print("print it at 100 %, and measure its frame: 130 mm across, 190 mm along")
    print_files([output])


def _undated(ending: str) -> dict[str, None]:
    return {"Date": None} if ending == ".svg" else {"CreationDate": None}


def _check_picture(picture: Path, photo: Path) -> None:
    if picture.suffix.lower() not in PICTURES:
        raise InputError(f"{picture}: the ending is not one of {' '.join(PICTURES)}")
    if picture.resolve() == photo.resolve():
        raise InputError(f"{picture}: is the photo itself; name another file for the picture")


def _draw(result: "StripPhoto", path: Path) -> None:
    from simulearn.show.photo import photo_picture

    figure = photo_picture(result)
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=DPI)


def _rise(result: "StripPhoto", text: "FormText | None") -> tuple[float, str]:
    """Return the rise with its sign, and whence the sign is.

    Raises:
        InputError: the form needs a sign, and nothing tells it.
    """
    size = result.measures.rise
    if result.sign is not None:
        return result.rise, "hollow on the side that was up" if result.sign > 0 else (
            "hollow on the side that was down"
        )
    if text is None:
        return size, "without a sign; --up says which side was up in the printer"
    if text.expected_sign is None:
        raise InputError(
            f"strip {text.strip} has actuators on no side or on both, so that its rise needs a "
            "sign: --up inside if it is hollow on the side that was up in the printer, else "
            "--up outside",
            "photo-up",
        )
    half = "top" if text.expected_sign > 0 else "bottom"
    return size * text.expected_sign, f"its sign is that of its actuators in the {half} half"


def _print(result: "StripPhoto", rise: float, why: str) -> None:
    from simulearn.calibrate.photo_reference import found

    size, curve = result.measures, result.curve
    sign = "+" if "sign;" not in why and rise > 0 else ""
    out.print(f"chord  {size.chord:7.2f} mm  ± {size.chord_deviation:.2f}")
    out.print(f"rise   {f'{sign}{rise:.2f}':>7} mm  ± {size.rise_deviation:.2f}  ({why})")
    out.print(f"strip  {curve.length:7.2f} mm along its middle, {curve.thickness:.2f} mm thick")
    out.print(escape(f"by     {found(result.reference)}"))
    for message in result.messages:
        if message.code in NOTES:
            out.print(escape(f"note: {message.message}"))
        else:
            _warn(message.message)


def _warn(text: str) -> None:
    err.print(f"[yellow]warning:[/] {escape(text)}")
