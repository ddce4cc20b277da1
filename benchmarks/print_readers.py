"""Let the programs of print servers read a file for each printer, and say what they find.

make readers
python benchmarks/print_readers.py
"""

import json
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

from report import Report
from simulearn.fabricate import load_printer, prepare, printers, write_gcode
from simulearn.fabricate.thumbnail import thumbnails
from simulearn.grid import make

ROOT = Path(__file__).parent.parent
PYTHON = ROOT / ".venv-readers" / "bin" / "python"
SCRIPT = ROOT / "tests" / "fabricate" / "readers" / "read_files.py"
REQUIREMENTS = SCRIPT.with_name("requirements.txt")
ROUNDS = 5


def seconds(work) -> float:
    """Return the least processor time that some work takes, s."""
    times = []
    for _ in range(ROUNDS):
        begin = process_time()
        work()
        times.append(process_time() - begin)
    return min(times)


def main() -> None:
    """Write the files, have them read, and report."""
    if not PYTHON.exists():
        sys.exit("the programs are not installed; run: make readers")
    jobs = {name: prepare([make("cone")], load_printer(name), ["cone"]) for name in printers()}
    with TemporaryDirectory() as folder:
        for name, job in jobs.items():
            write_gcode(job.gcode, Path(folder) / f"{name}.gcode")
        command = [str(PYTHON), str(SCRIPT), folder]
        answers = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    lines = REQUIREMENTS.read_text().splitlines()
    named = ("moonraker", "octoprint", "py-gcode-metadata", "bambox")
    report = Report("print_readers", "Print files, read by other programs")
    report.say(
        "The library's cone on each printer, read by "
        + ", ".join(line.replace("==", " ") for line in lines if line.split("==")[0] in named)
        + ". The first two columns are ours, the others theirs. OctoPrint knows no accelerations; "
        "it counts what the start code feeds, and how high."
    )
    rows = []
    for name, job in jobs.items():
        says = answers[f"{name}.gcode"]
        m, o, p = says["moonraker"], says["octoprint"], says["prusa"]
        pictures = [f"{each['width']}x{each['height']}" for each in m.get("thumbnails", [])]
        rows.append(
            [
                name,
                f"{job.estimate.seconds:.0f} s, {job.estimate.filament_mm:.2f} mm",
                f"{m['estimated_time']:.0f} s, {m['filament_total']:.2f} mm, "
                f"{m['filament_type']}, {m['layer_count']} layers of {m['layer_height']:g}, "
                f"{m['object_height']:g} mm high, {m['first_layer_extr_temp']:g} C",
                " ".join(pictures) or "-",
                f"{60 * o['total_time']:.0f} s, {o['extrusion_length'][0]:.2f} mm, "
                f"{o['dimensions']['height']:g} mm high",
                f"{p['printer_model']}, {p['estimated printing time (normal mode)']}, "
                f"{p['filament used [g]']:g} g {p['filament_type']}, {p['temperature']} C",
            ]
        )
    head = ("printer", "in the file", "Moonraker", "its pictures", "OctoPrint", "gcode-metadata")
    report.table(head, rows)
    packed = {name: answers[f"{name}.gcode"].get("bambox_pack") for name in jobs}
    report.say(
        "bambox packs with all its safety checks and validates: "
        + "; ".join(
            f"{name}: {len(said['errors'])} errors, {len(said['warnings'])} warnings"
            for name, said in packed.items()
            if said
        )
        + "."
    )
    costs = []
    for name in ("voron", "prusa-mk4"):
        path, firmware = jobs[name].path, jobs[name].printer.firmware
        costs.append(f"{seconds(lambda p=path, f=firmware: list(thumbnails(p, f))):.2f} s ({name})")
    report.say(f"The small pictures take {' and '.join(costs)} of processor time.")
    report.save()


if __name__ == "__main__":
    main()
