"""Estimate how long a grid of 150 x 150 mm prints, beside the paper's 45 minutes.

python benchmarks/print_time.py
"""

import numpy as np
import shapely

from report import Report
from simulearn.fabricate import Job, load_printer, prepare, printers
from simulearn.fabricate.moves import PRINT, RETRACT
from simulearn.fabricate.regions import Plan
from simulearn.grid import Rules, draw_valid, make

PAPER = 45.0  # minutes (Yang et al., SimuLearn, UIST 2020, p. 4)
SIDE, WIDTH = 150.0, 7.2
SEED, DESIGNS = 150, 40


def bare(job: Job) -> float:
    """Return the time (min) of the beads alone, with a machine that accelerates at once."""
    layers = (bead for layer in job.path.layers for bead in layer.beads)
    return sum(float(bead.lengths.sum()) / bead.speed for bead in layers)


def minutes(job: Job) -> float:
    """Return the estimated time, min."""
    return job.estimate.seconds / 60


def covered(job: Job) -> tuple[float, float]:
    """Return the smallest share (%) of the outline under beads, and the overlap (%) of their areas.

    Over the four kinds of layer.
    """
    plans = [Plan(g, job.material.section, job.settings.line, 1) for g in job.grids]
    whole = shapely.union_all([plan.union for plan in plans])
    shares, more = [], []
    half = len(job.path.layers) // 2
    for k in (0, 1, half, half + 1):
        beads = [bead for bead in job.path.layers[k].beads if bead.role != "skirt"]
        ends = np.concatenate([np.stack([b.points[:-1], b.points[1:]], axis=1) for b in beads])
        widths = np.concatenate([b.widths for b in beads])
        strips = shapely.buffer(shapely.linestrings(ends), widths / 2, cap_style="square")
        cover = shapely.intersection(shapely.union_all(strips), whole)
        shares.append(100 * shapely.area(cover) / shapely.area(whole))
        area = sum(float(b.lengths @ b.widths) for b in beads)
        more.append(100 * (area / shapely.area(whole) - 1))
    return min(shares), max(more)


def main() -> None:
    """Estimate and report."""
    length = (SIDE - WIDTH) / 2
    saddle = make("saddle", (2, 2), length)
    report = Report("print_time", "Print time")
    report.say(
        f"A 2x2 grid of {SIDE:g} x {SIDE:g} mm over all (beams of {length:g} mm), estimated with "
        f"the acceleration and corner speed of each profile; heating comes on top. The paper "
        f"names {PAPER:g} min for a grid of this size, without its printer or its design."
    )
    rows = []
    for name in printers():
        printer = load_printer(name)
        jobs = [prepare([make(d, (2, 2), length)], printer) for d in ("flat", "dome")]
        jobs.append(prepare([saddle], printer))
        times = [minutes(job) for job in jobs]
        travels = float((jobs[2].moves.kind == RETRACT).sum()) / len(jobs[2].path.layers)
        share = 100 * jobs[2].durations[jobs[2].moves.kind != PRINT].sum()
        share /= jobs[2].estimate.seconds
        rows.append(
            [
                name,
                *(f"{t:.1f}" for t in times),
                f"{max(times) / PAPER:.2f}",
                f"{travels:.1f}",
                f"{share:.1f}",
                f"{jobs[2].estimate.filament_g:.1f}",
            ]
        )
    report.table(
        [
            "printer",
            "flat, min",
            "dome, min",
            "saddle, min",
            "longest / paper",
            "lifted travels a layer",
            "not printing, % of the time",
            "filament, g",
        ],
        rows,
    )
    job = prepare([saddle], load_printer("modix-big60"))
    report.say(
        f"The beads alone are {bare(job):.1f} min long at the deck's {3000} mm/min "
        f"({sum(b.lengths.sum() for q in job.path.layers for b in q.beads) / 1000:.0f} m): rows of "
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
        f"{np.mean(travels):.1f} lifted travels on average; beads are {every.min():.2f} to "
        f"{every.max():.2f} mm wide, 98 % of them {np.percentile(every, 1):.2f} to "
        f"{np.percentile(every, 99):.2f} mm."
    )
    report.save()


if __name__ == "__main__":
    main()
