"""Run the print files of all printers on machines: simulated ones, and klippy and GPX if given.

python benchmarks/print_files.py [--klippy klippy.py --python PYTHON --dictionary klipper.dict]
    [--gpx gpx] [--profiles 5000]

klippy (Klipper's host program) runs a file in batch mode with a printer.cfg of the profile's
limits; it needs the data dictionary of a micro-controller built for Linux. GPX makes X3G for a
Replicator.
"""

import argparse
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

import hypothesis

from report import Report
from simulearn.fabricate import Job, printers

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "fabricate" / "firmware"))
import fuzzed_profiles
import test_fuzzed_profiles
import test_prints_run as runs
from virtual_printer import simulate
from x3g import check_film, read_x3g

GRIDS = ("twist", "cone", "wave")
STEPPER = """[stepper_{axis}]
step_pin: gpiochip0/gpio{a}
dir_pin: gpiochip0/gpio{b}
enable_pin: !gpiochip0/gpio{c}
endstop_pin: ^gpiochip0/gpio{d}
microsteps: 16
rotation_distance: 40
position_min: {low}
position_max: {high}
position_endstop: {end}
"""
CONFIGURATION = """[mcu]
serial: /dev/null
[printer]
kinematics: cartesian
max_velocity: {speed}
max_accel: {acceleration}
max_z_velocity: {speed_z}
max_z_accel: {acceleration_z}
square_corner_velocity: {corner}
{steppers}
[extruder]
step_pin: gpiochip0/gpio12
dir_pin: gpiochip0/gpio13
enable_pin: !gpiochip0/gpio14
microsteps: 16
rotation_distance: 22.6
nozzle_diameter: {nozzle}
filament_diameter: {filament}
max_extrude_only_accel: {acceleration_e}
heater_pin: gpiochip0/gpio15
sensor_type: ATC Semitec 104GT-2
sensor_pin: analog0
control: pid
pid_Kp: 22
pid_Ki: 1
pid_Kd: 114
min_temp: 0
max_temp: {nozzle_most}
[heater_bed]
heater_pin: gpiochip0/gpio16
sensor_type: ATC Semitec 104GT-2
sensor_pin: analog1
control: watermark
min_temp: 0
max_temp: {bed_most}
[fan]
pin: gpiochip0/gpio17
[display_status]
[exclude_object]
[pause_resume]
[virtual_sdcard]
path: {folder}
[gcode_macro PRINT_START]
gcode:
  G28
  G90
  G0 Z10 F600
[gcode_macro PRINT_END]
gcode:
  M84
"""


def configuration(job: Job, folder: str) -> str:
    """Return a printer.cfg with the limits of a profile."""
    printer, bed = job.printer, job.printer.bed
    spans = ((bed.low[0], bed.high[0]), (bed.low[1], bed.high[1]), (0.0, bed.height))
    steppers = "".join(
        STEPPER.format(
            axis=axis, low=low, high=high, end=0 if axis == "z" else high,
            a=4 * k, b=4 * k + 1, c=4 * k + 2, d=4 * k + 3,
        )
        for k, (axis, (low, high)) in enumerate(zip("xyz", spans, strict=True))
    )  # fmt: skip
    motion = printer.motion
    return CONFIGURATION.format(
        speed=motion.speed / 60,
        speed_z=motion.speed_z / 60,
        acceleration=max(motion.acceleration, motion.acceleration_travel),
        acceleration_z=motion.acceleration_z,
        acceleration_e=motion.acceleration_e,
        corner=motion.corner_speed,
        nozzle=job.settings.nozzle,
        filament=job.settings.filament,
        nozzle_most=printer.temperature.nozzle_most,
        bed_most=printer.temperature.bed_most,
        steppers=steppers,
        folder=folder,
    )


def klippy(words: argparse.Namespace, job: Job, text: str) -> tuple[float, int, int]:
    """Return how long klippy takes for a file (s of the machine), its errors and unknown commands.

    Raises:
        SystemExit: klippy did not run to the end.
    """
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "printer.cfg").write_text(configuration(job, name))
        (folder / "print.gcode").write_text(text)
        log = folder / "klippy.log"
        command = [words.python, words.klippy, folder / "printer.cfg", "-d", words.dictionary]
        command += ["-i", folder / "print.gcode", "-o", folder / "out", "-l", log]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
        said = log.read_text() if log.exists() else done.stderr
    end = re.search(r"Exiting \(print time ([\d.]+)s\)", said)
    errors = len(re.findall(r"^(?:!!|.*[Ee]rror on|Traceback)", said, re.MULTILINE))
    errors += done.returncode != 0
    if end is None:
        sys.exit(f"klippy stopped: {said[-500:]}")
    return float(end[1]), errors, said.count("Unknown command")


def by_klippy(words: argparse.Namespace, report: Report, jobs: dict[str, Job]) -> None:
    """Report what klippy says of the Voron's files."""
    rows = []
    for name, job in jobs.items():
        start = job.gcode.split("\n;LAYER:0\n")[0] + "\n"
        total, errors, unknown = klippy(words, job, job.gcode)
        seconds = total - klippy(words, job, start)[0]
        ours = job.estimate.seconds
        rows.append(
            [name, len(job.gcode.splitlines()), errors, unknown, f"{ours:.0f}", f"{seconds:.0f}",
             f"{100 * (ours / seconds - 1):+.2f} %"]
        )  # fmt: skip
    version = git(Path(words.klippy).parent)
    report.say(
        f"klippy {version} in batch mode, with a printer.cfg of the Voron's limits; time from the "
        f"first layer on (homing and heating are left out)."
    )
    head = [
        "grid",
        "lines",
        "errors",
        "unknown commands",
        "header, s",
        "klippy, s",
        "header/klippy",
    ]
    report.table(head, rows)


def by_gpx(words: argparse.Namespace, report: Report, jobs: dict[str, Job]) -> None:
    """Report what GPX makes of the Replicator's files."""
    rows = []
    for name, job in jobs.items():
        with TemporaryDirectory() as folder:
            source, target = Path(folder) / "print.gcode", Path(folder) / "print.x3g"
            source.write_text(job.gcode)
            command = [words.gpx, "-r", "-m", "r2x", str(source), str(target)]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            film = read_x3g(target.read_bytes())
        check_film(film, job)
        x, y, z = zip(*film.places, strict=True)
        ours = job.estimate
        rows.append(
            [name, len((done.stdout + done.stderr).splitlines()), len(film.places),
             f"{min(x):.1f} to {max(x):.1f}", f"{min(y):.1f} to {max(y):.1f}", f"{max(z):.1f}",
             f"{ours.filament_mm:.0f}", f"{film.fed:.0f}", f"{ours.seconds:.0f}",
             f"{film.seconds:.0f}"]
        )  # fmt: skip
    shown = subprocess.run([words.gpx, "-?"], capture_output=True, text=True, check=False)
    version = (re.findall(r"GPX \d\S*", shown.stdout + shown.stderr) or ["GPX"])[0]
    report.say(
        f"`gpx -r -m r2x` ({version}): x and y are homed upwards, then z downwards; the places of "
        f"the axes are recalled before anything moves; all places lie within 246 x 152 x 155 mm "
        f"about the middle. GPX's time knows no acceleration."
    )
    head = ["grid", "warnings", "moves", "x, mm", "y, mm", "highest z, mm"]
    head += ["filament by header, mm", "in the X3G, mm", "header, s", "GPX, s"]
    report.table(head, rows)


def by_simulation(report: Report) -> dict[tuple[str, str], Job]:
    """Report what the simulated machines do with every printer's files."""
    jobs, rows, dangers, files = {}, [], Counter(), 0
    for name in printers():
        for which in (*runs.GRIDS, "large"):
            job = jobs[name, which] = runs.printed(name, which)
            trace = simulate(job.gcode, runs.limits_of(job.printer))
            dangers.update(danger.what for danger in trace.dangers)
            files += 1
            if which in GRIDS:
                rows.append(
                    [name, which, f"{job.estimate.seconds:.0f}", len(job.path.layers),
                     f"{job.estimate.filament_mm:.2f}", f"{trace.beads[:, 5].sum():.2f}",
                     len(trace.beads), len(trace.dangers)]
                )  # fmt: skip
    found = ", ".join(f"{n} {what}" for what, n in dangers.items()) or "none"
    report.say(
        f"{files} files (7 printers; twist, cone, a wave of 2x3 cells, a small twist, two grids at "
        f"once, a large square), each run on a machine simulated by its firmware's rules "
        f"(tests/fabricate/firmware): dangers {found}."
    )
    head = ["printer", "grid", "time by header, s", "layers", "filament by header, mm"]
    report.table([*head, "fed by the machine, mm", "beads", "dangers"], rows)
    return jobs


def by_profiles(report: Report, examples: int) -> None:
    """Report how many fuzzed profiles are refused, printed, and a danger."""
    counts: Counter[str] = Counter()

    @hypothesis.settings(
        max_examples=examples,
        deadline=None,
        database=None,
        phases=[hypothesis.Phase.generate],
        suppress_health_check=list(hypothesis.HealthCheck),
    )
    @hypothesis.seed(15)
    @hypothesis.given(fuzzed_profiles.profiles())
    def run(data) -> None:
        found = test_fuzzed_profiles.result(data)
        refused = isinstance(found, Exception)
        counts["refused" if refused else "printed"] += 1
        if not refused and found.dangers:
            counts["dangers"] += 1

    run()
    report.say(
        f"{counts['refused'] + counts['printed']} fuzzed profiles (odd lines in sound start and "
        f"end code, tables of any kind; seed 15): {counts['refused']} refused with one message, "
        f"{counts['printed']} printed, {counts['dangers']} of those with a danger. Each file is "
        f"run twice, the second time as the first has left the machine."
    )


def git(folder: Path) -> str:
    """Return the version of a checkout, or nothing."""
    command = ["git", "-C", str(folder), "describe", "--tags", "--always"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout.strip()


def main() -> None:
    """Run the files and report."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--klippy", default=os.environ.get("SIMULEARN_KLIPPY"))
    parser.add_argument("--python", default=os.environ.get("SIMULEARN_KLIPPY_PYTHON", "python3"))
    parser.add_argument("--dictionary", default=os.environ.get("SIMULEARN_KLIPPY_DICTIONARY"))
    parser.add_argument("--gpx", default=os.environ.get("SIMULEARN_GPX"))
    parser.add_argument("--profiles", type=int, default=1000)
    words = parser.parse_args()
    report = Report("print_files", "Print files, run on machines")
    jobs = by_simulation(report)
    if words.klippy and words.dictionary:
        by_klippy(words, report, {which: jobs["voron", which] for which in GRIDS})
    else:
        report.say("klippy was not given, and has not run.")
    if words.gpx:
        by_gpx(words, report, {which: jobs["makerbot-2x", which] for which in GRIDS})
    else:
        report.say("GPX was not given, and has not run.")
    by_profiles(report, words.profiles)
    report.save()


if __name__ == "__main__":
    main()
