"""Estimate how long a grid of 150 x 150 mm prints, and how evenly its plastic lies.

python benchmarks/print_time.py
"""

from dataclasses import replace

import numpy as np
import shapely

from evenness import area_of, local_mass, most_seams, repeated
from report import Report
from simulearn.fabricate import Job, load_printer, prepare, printers
from simulearn.fabricate.moves import PRINT, RETRACT, TRAVEL
from simulearn.fabricate.short_strokes import mean_speeds
from simulearn.fabricate.toolpath import BRIM, SKIRT
from simulearn.grid import Rules, draw_valid, make

PAPER = 45.0  # minutes (Yang et al., SimuLearn, UIST 2020, p. 4)
SIDE, WIDTH = 150.0, 7.2
SEED, DESIGNS = 150, 40
CIRCLES = (1.8, 0.6)  # mm


def bare(job: Job) -> float:
    """Return the time (min) of the grid's beads alone, all at the speed of the fill."""
    beads = (b for layer in job.path.layers for b in layer.beads if b.role not in (SKIRT, BRIM))
    return sum(float(bead.lengths.sum()) for bead in beads) / job.material.print.speed_fill


def minutes(job: Job) -> float:
    """Return the estimated time, min."""
    return job.estimate.seconds / 60


def covered(job: Job) -> tuple[float, float]:
    """Return the smallest share (%) of the outline under beads, and the overlap (%) of their areas.

    Over the four kinds of layer.
    """
    whole = area_of(job)
    shares, more = [], []
    half = len(job.path.layers) // 2
    for k in (0, 1, half, half + 1):
        beads = [bead for bead in job.path.layers[k].beads if bead.role not in (SKIRT, BRIM)]
        ends = np.concatenate([np.stack([b.points[:-1], b.points[1:]], axis=1) for b in beads])
        widths = np.concatenate([b.widths for b in beads])
        strips = shapely.buffer(shapely.linestrings(ends), widths / 2, cap_style="square")
        cover = shapely.intersection(shapely.union_all(strips), whole)
        shares.append(100 * shapely.area(cover) / shapely.area(whole))
        area = sum(float(b.lengths @ b.widths) for b in beads)
        more.append(100 * (area / shapely.area(whole) - 1))
    return min(shares), max(more)


def changed(name: str, **overrides: float) -> Job:
    """Return the print of the saddle with other settings."""
    printer = load_printer(name)
    printer = printer.model_copy(update={"print": printer.print | overrides})
    return prepare([make("saddle", (2, 2), (SIDE - WIDTH) / 2)], printer)


def far_travels(job: Job) -> float:
    """Return how many travels of a layer are longer than two rows."""
    steps = np.diff(job.moves.places, axis=0, prepend=job.moves.start[None])
    far = np.linalg.norm(steps, axis=1) > 2 * job.settings.line
    return float((far & (job.moves.kind == TRAVEL)).sum()) / len(job.path.layers)


def evenness(report: Report) -> None:
    """Report seams and local mass, and what they would be if layers were alike."""
    printer = load_printer("stacker-s4")
    designs = {
        "twist": make("twist"),
        "cone": make("cone"),
        "wave, 2x3": make("wave", (2, 3), 50.0),
        f"random {SEED}/3": draw_valid(Rules(), SEED, 3)[0],
    }
    rows = []
    for name, grid in designs.items():
        job = prepare([grid], printer)
        half = len(job.path.layers) // 2
        printed = list(job.path.layers)
        for what, layers in (("as printed", printed), ("if alike", repeated(job))):
            cells = [name, what, f"{most_seams(layers)} of {len(layers)}"]
            for circle in CIRCLES:
                mass = local_mass(job, layers, circle)
                least, high, most = *np.percentile(mass, (1, 99)), mass.max()
                cells.append(f"{least:.2f} / {high:.2f} / {most:.2f}")
            halves = [local_mass(job, layers[h : h + half], CIRCLES[0]) for h in (0, half)]
            cells.append(" / ".join(f"{mass.max():.2f}" for mass in halves))
            rows.append(cells)
    report.say(
        f"Local mass: volume laid over volume of the solid, all 16 layers, within circles of "
        f"{CIRCLES[0]} and {CIRCLES[1]} mm (1 % / 99 % / most). Seams: shells that begin at the "
        f"same point. If alike: with layers of a half and a parity that all begin at the same ends "
        f"and corners."
    )
    head = ["design", "layers", "seams at one point"]
    head += [f"mass within {circle} mm" for circle in CIRCLES]
    report.table([*head, f"most within {CIRCLES[0]} mm, bottom / top half"], rows)


def main() -> None:
    """Estimate and report."""
    length = (SIDE - WIDTH) / 2
    saddle = make("saddle", (2, 2), length)
    report = Report("print_time", "Print time")
    report.say(
        f"A 2x2 grid of {SIDE:g} x {SIDE:g} mm over all (beams of {length:g} mm), with skirt, brim "
        f"and slow first layer; estimated with the acceleration and corner speed of the material, "
        f"or of the machine where they are lower; heating comes on top. The paper names {PAPER:g} "
        f"min for a grid of this size, without its printer or its design. Short strokes: mean "
        f"speed of the saddle's passive and joint strokes as printed, in the calibration, and with "
        f"all that the machine can."
    )
    rows = []
    for name in printers():
        printer = load_printer(name)
        jobs = [prepare([make(d, (2, 2), length)], printer) for d in ("flat", "dome")]
        jobs.append(prepare([saddle], printer))
        times = [minutes(job) for job in jobs]
        travels = float((jobs[2].moves.kind == RETRACT).sum()) / len(jobs[2].path.layers)
        job = jobs[2]
        speeds = mean_speeds(job.path, job.moves, job.settings, printer, job.material)
        motion = printer.motion
        own = replace(
            job.settings, acceleration=motion.acceleration, corner_speed=motion.corner_speed
        )
        able = mean_speeds(job.path, job.moves, own, printer, job.material)[0]
        share = 100 * jobs[2].durations[jobs[2].moves.kind != PRINT].sum()
        share /= jobs[2].estimate.seconds
        rows.append(
            [
                name,
                *(f"{t:.1f}" for t in times),
                f"{max(times) / PAPER:.2f}",
                f"{travels:.1f} of {far_travels(jobs[2]):.1f}",
                f"{share:.1f}",
                f"{jobs[2].estimate.filament_g:.1f}",
                f"{speeds[0]:.1f} / {speeds[1]:.1f} / {able:.1f}",
            ]
        )
    report.table(
        [
            "printer",
            "flat, min",
            "dome, min",
            "saddle, min",
            "longest / paper",
            "retractions a layer, of travels beyond two rows",
            "not printing, % of the time",
            "filament, g",
            "short strokes, mm/s",
        ],
        rows,
    )
    full, bare_bed = changed("stacker-s4"), changed("stacker-s4", brim=0.0)
    quick = changed("stacker-s4", brim=0.0, first_layer_speed=3000.0, first_layer_flow=1.0)
    report.say(
        f"Of that (saddle, stacker-s4) the brim of {full.material.print.brim:g} mm takes "
        f"{minutes(full) - minutes(bare_bed):.1f} min and "
        f"{full.estimate.filament_g - bare_bed.estimate.filament_g:.2f} g, the slow first layer "
        f"{minutes(bare_bed) - minutes(quick):.1f} min, its flow "
        f"{bare_bed.estimate.filament_g - quick.estimate.filament_g:.2f} g."
    )
    evenness(report)
    job = prepare([saddle], load_printer("modix-big60"))
    speed = job.material.print.speed_fill
    report.say(
        f"The grid's beads alone take {bare(job):.1f} min at the deck's "
        f"{speed:g} mm/min ({bare(job) * speed / 1000:.0f} m): rows of "
        f"{job.settings.line:g} mm that fill 16 layers cannot be laid in {PAPER:g} min at that "
        f"speed. The paper's print was smaller, faster or less than full."
    )
    printer = load_printer("modix-big60")
    shares, overlaps, travels, widths = [], [], [], []
    for k in range(DESIGNS):
        job = prepare([draw_valid(Rules(), SEED, k)[0]], printer)
        share, more = covered(job)
        shares.append(share)
        overlaps.append(more)
        travels.append(float((job.moves.kind == RETRACT).sum()) / len(job.path.layers))
        widths += [w for layer in job.path.layers for b in layer.beads for w in (b.widths,)]
    every = np.concatenate(widths)
    report.say(
        f"{DESIGNS} random designs (seed {SEED}), four kinds of layer each: beads cover at least "
        f"{min(shares):.2f} % of the outline; their areas add up to at most {max(overlaps):.1f} % "
        f"more than the outline's (the overlap of strokes with shells and neighbours); a layer has "
        f"{np.mean(travels):.1f} retractions on average; beads are {every.min():.2f} to "
        f"{every.max():.2f} mm wide, 98 % of them {np.percentile(every, 1):.2f} to "
        f"{np.percentile(every, 99):.2f} mm."
    )
    report.save()


if __name__ == "__main__":
    main()
