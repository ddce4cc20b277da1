"""A data set at a glance: histograms of its designs and their motion, and a few of its grids."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from simulearn.dataset import Dataset
from simulearn.dataset.statistics import Quantity, quantities
from simulearn.show import style
from simulearn.show.flat import draw_flat

SHOWN = ("dimension", "net_length", "actuator", "motion", "motion_percent", "creep_share")
GRIDS = 6


def dataset_picture(data: Dataset) -> Figure:
    """Return histograms of a data set, the paper's figures marked, above some of its designs."""
    figure = Figure(figsize=(8.4, 6.6), dpi=style.DPI, layout="constrained")
    rows = np.atleast_1d(figure.subfigures(2, 1, height_ratios=[2.6, 1]))  # type: ignore[arg-type]
    axes = rows[0].subplots(2, 3)
    for ax, name in zip(axes.flat, SHOWN, strict=True):
        _histogram(ax, quantities(data)[name])
    for k, ax in enumerate(np.atleast_1d(rows[1].subplots(1, GRIDS))):
        _design(ax, data, k)
    figure.suptitle(
        f"{data.config.name}: {len(data):,} trials, {len(data.failures)} failed, "
        f"seed {data.config.seed}",
        fontsize=10,
    )
    return style.ink(figure)


def _histogram(ax: Axes, quantity: Quantity) -> None:
    values = quantity.values
    discrete = len(np.unique(values)) < 20
    bins = np.arange(-1.125, 1.2, 0.25) if discrete else 40
    ax.hist(values, bins=bins, color="#9db7c9", edgecolor="white", linewidth=0.4)  # type: ignore[arg-type]
    if not discrete:
        for p in (3, 97):
            ax.axvline(float(np.percentile(values, p)), color=style.INK, lw=0.7, ls=":")
        ax.axvline(float(values.mean()), color=style.INK, lw=0.9)
    for k, (name, value) in enumerate(quantity.paper.items()):
        ax.axvline(
            value,
            color=style.TOP,
            lw=0.9,
            ls="-" if name == "mean" else ":",
            label="the paper's" if k == 0 else None,
        )
    if quantity.paper:
        ax.legend(frameon=False, fontsize=7)
    ax.set_title(quantity.words, fontsize=8.5, loc="left")
    ax.set_xlabel(
        f"{quantity.unit}  ·  mean {values.mean():.2f}, 3 % {np.percentile(values, 3):.1f}, "
        f"97 % {np.percentile(values, 97):.1f}".lstrip(" ·"),
        fontsize=7,
    )
    ax.tick_params(labelsize=7)
    ax.set_yticks([])
    for side in ("top", "right", "left"):
        ax.spines[side].set_visible(False)


def _design(ax: Axes, data: Dataset, k: int) -> None:
    """Draw one design of each batch in turn."""
    batch = data.batches[k % len(data.batches)]
    ax.set_axis_off()
    ax.set_aspect("equal")
    if k // len(data.batches) < len(batch):
        draw_flat(ax, batch.grid(k // len(data.batches)), numbers=False)
        ax.autoscale_view()
