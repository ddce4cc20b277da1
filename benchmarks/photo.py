"""How exactly chord and rise of a strip are read from photos, drawn with known answers.

    python benchmarks/photo.py [--scenes 60] [--picture]

Each scene is a strip, a camera, lamps and a colour as people may have them (`strip_photos.py`).
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from report import FOLDER, Report
from simulearn.calibrate.photo import StripPhoto, measure_photo
from simulearn.errors import InputError
from simulearn.material import load_material
from strip_photos import RULER, Scene, random_scene, save

SECTION = load_material("pla-hot-water").section
SIZE = (2000, 1500)
PICTURE = FOLDER.parent / "pictures" / "photo.png"


def sized(scene: Scene, **lens: object) -> Scene:
    """Return a scene in a photo of SIZE, its lens changed."""
    return replace(scene, lens=replace(scene.lens, size=SIZE, **lens))


def measured(scene: Scene, folder: Path, exif: bool = True) -> StripPhoto | InputError:
    """Return what is read from the photo of a scene, or why it is refused."""
    path = save(scene, folder / "photo.jpg", exif=exif)
    scale = None
    if not scene.sheet:
        ends = scene.lens.seen(np.array([[*end, 0.0] for end in RULER]))
        scale = ",".join(f"{value:.1f}" for value in ends.ravel()) + "=100"
    try:
        return measure_photo(path, SECTION, scale=scale)
    except InputError as error:
        return error


def errors(
    name: str, scenes: list[Scene], folder: Path, exif: bool = True
) -> tuple[list[str], list[str]]:
    """Return the row of a group of scenes, and what was refused."""
    rows, refused = [], []
    for k, scene in enumerate(scenes):
        result = measured(scene, folder, exif)
        if isinstance(result, InputError):
            refused.append(f"{name}, scene {k}, {scene.colour}: {result.code}")
            print(refused[-1], file=sys.stderr, flush=True)
            continue
        chord, rise = scene.strips[0].measures()
        size = result.measures
        off = size.chord - chord, size.rise - rise
        rows.append((*off, off[0] / size.chord_deviation, off[1] / size.rise_deviation))
        print(name, k, scene.colour, *(f"{value:+.3f}" for value in rows[-1]), file=sys.stderr)
    if not rows:
        return [name, f"0 of {len(scenes)}", *["-"] * 6], refused
    table = np.array(rows)
    rms, bias, most = np.sqrt((table**2).mean(0)), table.mean(0), np.abs(table).max(0)
    row = [
        name,
        f"{len(rows)} of {len(scenes)}",
        *(f"{rms[k]:.2f} ({bias[k]:+.2f}), {most[k]:.2f}" for k in (0, 1)),
        *(f"{rms[k]:.1f}" for k in (2, 3)),
    ]
    return row, refused


def main() -> None:
    """Measure all groups and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--scenes", type=int, default=60, help="photos of the sheet")
    parser.add_argument("--picture", action="store_true", help="only draw the page's picture")
    arguments = parser.parse_args()
    if arguments.picture:
        picture()
        return
    count = arguments.scenes
    few = max(2, count // 10)
    report = Report("photo", "Strips measured in photos")
    plain = []
    for k in range(few):  # the strip over the ruler, and not on it
        scene = random_scene(300 + k, sheet=False, note=False)
        strip = replace(scene.strips[0], place=(90.0, 115.0))
        plain.append(sized(replace(scene, strips=(strip,)), tilt=k % few, distance=380))
    groups = [
        ("white sheet", [sized(random_scene(k)) for k in range(count)], True),
        ("the same, lens not known", [sized(random_scene(k)) for k in range(few)], False),
        (
            "white strip, dark sheet",
            [sized(random_scene(100 + k, colour="white", dark=True)) for k in range(few)],
            True,
        ),
        (
            "white strip, white sheet",
            [sized(random_scene(200 + k, colour="white")) for k in range(few)],
            True,
        ),
        ("scale of 100 mm only, few degrees of tilt", plain, True),
    ]
    with TemporaryDirectory() as folder:
        results = [errors(name, scenes, Path(folder), exif) for name, scenes, exif in groups]
    report.say(
        f"Drawn photos of {SIZE[0]} x {SIZE[1]} pixels, from 300 to 600 mm, tilted by up to 20 "
        "degrees, with lenses of 24 to 28 mm that bend a little, one or two lamps with their "
        "shadows, uneven light, blur, noise, JPEG, and half of them with writing beside the strip; "
        "strips of any colour, 39 to 84 mm long. No real photo was measured."
    )
    report.table(
        [
            "photos",
            "measured",
            "chord: rms error (mean), largest, mm",
            "rise: the same",
            "chord: rms error over the deviation said",
            "rise: the same",
        ],
        [row for row, _ in results],
    )
    refused = [line for _, lines in results for line in lines]
    report.say("Refused: " + ("; ".join(refused) or "none") + ".")
    report.save()


def picture() -> None:
    """Draw what is found in one photo, for the page on measuring."""
    from PIL import Image

    from simulearn.show.photo import photo_picture

    with TemporaryDirectory() as folder:
        path = save(random_scene(2), Path(folder) / "photo.jpg")
        photo_picture(measure_photo(path, SECTION, up="inside")).savefig(
            drawn := Path(folder) / "found.png", dpi=150
        )
        with Image.open(drawn) as image:
            few = image.convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE)
        few.save(PICTURE, optimize=True)


if __name__ == "__main__":
    main()
