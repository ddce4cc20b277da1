"""Pictures about learning: loss curves, histograms of errors, answers over the reference.

Figures 8 to 11 and 20 of Yang et al., SimuLearn, UIST 2020: finite elements in grey, a model in
orange.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulearn.dataset import Batch
from simulearn.learn.common.evaluate import Evaluation
from simulearn.learn.common.model import Frames
from simulearn.learn.equilibrium.stages import StageRow
from simulearn.learn.paper.train import EpochRow
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.simulate import Result, skin

REFERENCE, ANSWER = "#8c8c8c", "#e8862e"
PAPER = {"mean": 3.03, "97 %": 4.13}  # % of dimension, the paper's test trials
PARTS = {"release": "release", "creep": "creep", "stress": "stress", "dislocation": "dislocation"}
SPACING = 3.0  # mm, length of the quadrilaterals along a beam


def loss_picture(rows: Sequence[EpochRow], name: str) -> Figure:
    """Return the course of a training: parts of the loss, and the error of trials set aside."""
    figure = Figure(figsize=(7.2, 2.9), dpi=style.DPI, layout="constrained")
    left, right = figure.subplots(1, 2)
    epochs = [row.epoch for row in rows]
    marks = {"marker": "."} if len(rows) < 3 else {}
    for part, words in PARTS.items():
        left.plot(epochs, [getattr(row, part) for row in rows], label=words, lw=1, **marks)
    left.set_yscale("log")
    left.set_ylabel("mean square, in increments", fontsize=8)
    left.legend(frameon=False, fontsize=7)
    right.plot(epochs, [row.validation_percent for row in rows], color=ANSWER, lw=1.2, **marks)
    right.set_yscale("log")
    right.set_ylabel("vertex error, % of dimension", fontsize=8)
    lowest = min(rows, key=lambda row: row.validation_percent)
    right.set_title(
        f"{name}: {rows[-1].validation_percent:.2f} % at the end, "
        f"{lowest.validation_percent:.2f} % at best",
        fontsize=8,
        loc="left",
    )
    right.yaxis.set_major_formatter("{x:g}")
    right.yaxis.set_minor_formatter("{x:g}")
    right.tick_params(which="both", labelsize=7)
    for ax in (left, right):
        _plain(ax)
        ax.set_xlabel("epoch", fontsize=8)
        for a, b in pairwise(rows):
            if a.unroll != b.unroll:
                ax.axvline(a.epoch + 0.5, color=style.INK, lw=0.6, ls=":")
    return style.ink(figure)


def stages_picture(rows: Sequence[StageRow], name: str) -> Figure:
    """Return the course of a fitting: the loss of each of its stages."""
    parts = {
        stage: [row for row in rows if row.stage == stage] for stage in {r.stage: 0 for r in rows}
    }
    figure = Figure(figsize=(2.4 * len(parts) + 0.3, 2.6), dpi=style.DPI, layout="constrained")
    for ax, (stage, part) in zip(
        figure.subplots(1, len(parts), squeeze=False)[0], parts.items(), strict=True
    ):
        ax.plot([r.update for r in part], [r.loss for r in part], color=ANSWER, lw=1.2)
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter("{x:g}")
        ax.yaxis.set_minor_formatter("{x:g}")
        ax.tick_params(which="both", labelsize=7)
        ax.set_title(f"{name}: {stage}, {part[-1].loss:.3g}", fontsize=8, loc="left")
        ax.set_xlabel("update", fontsize=8)
        _plain(ax)
    return style.ink(figure)


def error_picture(evaluation: Evaluation, name: str) -> Figure:
    """Return a histogram of the trials' errors, in % of dimension and in mm (Figure 10)."""
    figure = Figure(figsize=(7.2, 2.7), dpi=style.DPI, layout="constrained")
    axes = figure.subplots(1, 3)
    e = evaluation.errors
    last = e.percent[:, -1]
    for ax, values, unit in (
        (axes[0], last, "% of dimension"),
        (axes[1], e.vertex[:, -1], "mm"),
    ):
        ax.hist(values, bins=min(30, max(5, len(values) // 6)), color="#9db7c9", ec="white", lw=0.4)
        for value, ls in ((values.mean(), "-"), (np.percentile(values, 97), ":")):
            ax.axvline(float(value), color=style.INK, lw=0.9, ls=ls)
        ax.set_xlabel(
            f"vertex error, {unit}\nmean {values.mean():.2f} (—), "
            f"97 % {np.percentile(values, 97):.2f} (···), worst {values.max():.2f}",
            fontsize=7,
        )
        ax.set_xlim(left=0)
    axes[0].set_ylabel(f"of {len(last)} trials", fontsize=8)
    axes[0].set_title(f"{name}: last frame", fontsize=8, loc="left")
    frames = np.arange(e.percent.shape[1])
    axes[2].fill_between(
        frames,
        e.percent.min(axis=0),
        np.percentile(e.percent, 97, axis=0),
        color="#f6d9bd",
        lw=0,
    )
    axes[2].plot(frames, e.percent.mean(axis=0), color=ANSWER, lw=1.2)
    axes[2].set_xlabel("frame (mean; up to the 97th percentile)", fontsize=7)
    axes[2].set_ylabel("vertex error, % of dimension", fontsize=7)
    axes[2].set_ylim(bottom=0)
    for ax in axes:
        _plain(ax)
    return style.ink(figure)


def grids_picture(evaluation: Evaluation, name: str) -> Figure:
    """Return the best, the median and the worst answer over the reference (Figures 11 and 20)."""
    chosen = (("best", 0.0), ("median", 0.5), ("worst", 1.0))
    figure = Figure(figsize=(7.4, 2.9), dpi=style.DPI, layout="constrained")
    for ax, (words, quantile) in zip(figure.subplots(1, 3), chosen, strict=True):
        k = evaluation.example(quantile)
        batch, frames, t = evaluation.trial(k)
        draw_both(ax, *both(batch, frames, t))
        e = evaluation.errors
        ax.set_title(
            f"{words}: trial {e.numbers[k]}, {e.percent[k, -1]:.2f} % of {e.dimension[k]:.0f} mm",
            fontsize=8,
        )
    figure.supxlabel(f"finite elements in grey, {name} in orange", fontsize=7)
    return style.ink(figure)


def both(batch: Batch, frames: Frames, t: int) -> tuple[Result, Result]:
    """Return reference and answer of a trial of a batch."""
    grid = batch.grid(t)

    def result(joints: NDArray[Any], sections: NDArray[Any]) -> Result:
        corners = np.asarray(joints, float), np.asarray(sections, float)
        return Result(grid, "", *corners, None, 0.0, batch.material.identity)

    return (
        result(batch.joints[t], batch.sections[t]),
        result(frames.joints[t], frames.sections[t]),
    )


def draw_both(
    ax: Axes, reference: Result, answer: Result, frame: int = -1, camera: Camera = Camera()
) -> None:
    """Draw a frame of two results through each other: finite elements grey, the answer orange."""
    faces, depths, colours = [], [], []
    for result, colour in ((reference, REFERENCE), (answer, ANSWER)):
        surface = skin(result, SPACING)
        corners = surface.vertices[frame][surface.quads]
        normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        front = normals @ camera.axes[2] > 0
        projected = camera.see(corners[front])
        faces.append(projected[..., :2])
        depths.append(projected[..., 2].mean(axis=1))
        colours.append(camera.light(normals[front])[:, None] * np.array(to_rgb(colour)))
    order = np.argsort(np.concatenate(depths))
    shapes, rgb = np.concatenate(faces)[order], np.concatenate(colours)[order]
    ax.add_collection(
        PolyCollection(list(shapes), facecolors=rgb, edgecolors=rgb, linewidths=0.25),
        autolim=False,
    )
    low, high = shapes.reshape(-1, 2).min(axis=0), shapes.reshape(-1, 2).max(axis=0)
    margin = 0.04 * float(max(high - low))
    ax.set_xlim(low[0] - margin, high[0] + margin)
    ax.set_ylim(low[1] - margin, high[1] + margin)
    ax.set_aspect("equal")
    ax.axis("off")


def search_picture(figures: dict[str, Any]) -> Figure:
    """Return the results of a search: four panels as in the paper's Figure 9."""
    runs = figures["runs"]
    figure = Figure(figsize=(7.4, 5.0), dpi=style.DPI, layout="constrained")
    axes = figure.subplots(2, 2)
    for ax, (key, words) in zip(
        (axes[0, 0], axes[0, 1], axes[1, 1]),
        (("noise", "noise γ"), ("penalty", "dislocation penalty a"), ("trials", "trials")),
        strict=True,
    ):
        _marginal(ax, runs, key, words)
    ax = axes[1, 0]
    (x, noises), (y, penalties) = (_levels(runs, key) for key in ("noise", "penalty"))
    z, sizes = _levels(runs, "trials")
    aside = 0.25 * (z - (len(sizes) - 1) / 2)  # runs that differ by their trials alone
    error = [run["validation_percent"] for run in runs]
    area = 16 * (1 + z)
    shown = ax.scatter(x + aside, y, c=error, s=area, cmap="viridis_r")
    k = runs.index(figures["best"])
    ax.plot(x[k] + aside[k], y[k], "o", ms=13, mfc="none", mec=ANSWER, mew=1.5)
    ax.set_xticks(range(len(noises)), noises)
    ax.set_yticks(range(len(penalties)), penalties)
    ax.set_xlabel("noise γ", fontsize=8)
    ax.set_ylabel("penalty a", fontsize=8)
    ax.margins(0.12)
    ax.set_title(f"combinations; side by side {', '.join(sizes)} trials", fontsize=8, loc="left")
    bar = figure.colorbar(shown, ax=ax)
    bar.set_label("vertex error, %", fontsize=8)
    bar.ax.tick_params(labelsize=7)
    _plain(ax)
    return style.ink(figure)


def _levels(runs: Sequence[dict[str, Any]], key: str) -> tuple[NDArray[np.int64], list[str]]:
    """Return the level of each run in one of the parameters, and what the levels are."""
    levels = sorted({run[key] for run in runs})
    return np.array([levels.index(run[key]) for run in runs]), [f"{level:g}" for level in levels]


def _marginal(ax: Axes, runs: Sequence[dict[str, Any]], key: str, words: str) -> None:
    """Draw vertex error and gap of all runs over one of their parameters; lines join the best."""
    x, levels = _levels(runs, key)
    other = ax.twinx()
    for axes, column, colour, mark, label, aside in (
        (ax, "validation_percent", ANSWER, "o", "vertex error, % of dimension", -0.08),
        (other, "gap_mm", REFERENCE, "s", "dislocation, mm", 0.08),
    ):
        values = np.array([run[column] for run in runs])
        best = [values[x == k].min() for k in range(len(levels))]
        axes.plot(
            x + aside, values, mark, ms=3.5, color=colour, mfc="none" if mark == "s" else None
        )
        axes.plot(np.arange(len(levels)) + aside, best, "-", lw=1, color=colour)
        axes.set_ylabel(label, color=colour, fontsize=8)
        axes.tick_params(labelsize=7)
        axes.set_ylim(0, 1.06 * values.max())
    other.spines["top"].set_visible(False)
    ax.set_xticks(range(len(levels)), levels)
    ax.set_xlim(-0.4, len(levels) - 0.6)
    ax.set_xlabel(words, fontsize=8)
    _plain(ax)


def _plain(ax: Axes) -> None:
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    ax.tick_params(labelsize=7)
