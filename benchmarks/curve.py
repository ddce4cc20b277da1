"""Measure how models get better with the number of trials they learn from.

Each run is kept, so the command goes on where it was stopped, and reports the runs that are there.

    python benchmarks/curve.py [--runs data/curve] [--sizes 50 100 ...] [--report]
"""

import argparse
import json
from pathlib import Path

from matplotlib.figure import Figure

from network_only import fit_network_only
from report import Report
from simulearn.dataset import Dataset, read_dataset
from simulearn.files import replacing
from simulearn.learn.common.evaluate import evaluate, for_testing
from simulearn.learn.common.model import Model
from simulearn.learn.common.trials import split
from simulearn.learn.config import read_config
from simulearn.learn.equilibrium.config import EquilibriumConfig, Stage
from simulearn.learn.equilibrium.stages import Keeper
from simulearn.learn.equilibrium.train import train as train_equilibrium
from simulearn.learn.paper.config import PaperConfig
from simulearn.learn.paper.train import train as train_paper
from simulearn.show import style

SIZES = (50, 100, 200, 400, 800, 1600)
WORDS = {
    "paper": "paper's network",
    "network": "network only",
    "beams": "mechanics only",
    "equilibrium": "both",
}
COLOURS = ("#8c8c8c", "#8a5fb0", "#2a78b8", "#e8862e")
UPDATES = 6000  # of the network on mechanics
ALONE = (64, 16, 4)  # width, message and rounds of the network without
ALONE_STAGE = Stage(updates=4000, batch=16, rate=2e-3)
EPOCHS = (2, 15)  # of the paper's network: from true frames, in whole rollouts


def trained(name: str, size: int, data: Dataset, folder: Path) -> Model:
    """Return a model that has learnt from so many trials, or go on with one."""
    share = {"trials": size, "validation": 8}
    config = read_config("beams" if name == "network" else name).model_copy(update=share)
    folder.mkdir(parents=True, exist_ok=True)
    if name == "network":
        identity = f"{ALONE} {ALONE_STAGE} {size} {data.sha256}"
        keep = Keeper("network", folder / "network.safetensors", identity)
        batch = split(config, data)[0][0]
        return fit_network_only(batch, ALONE, ALONE_STAGE, config.seed, keep)
    if isinstance(config, EquilibriumConfig):
        stage = config.network and config.network.model_copy(update={"updates": UPDATES})
        lean = {"network": stage, "polish": None, "stress": None, "calibration": None}
        return train_equilibrium(config.model_copy(update=lean), data, folder)[0]
    assert isinstance(config, PaperConfig)
    batch = max(4, 16 * size // 1600)
    phases = [
        phase.model_copy(update={"batch": batch, "epochs": epochs})
        for phase, epochs in zip(config.phases, EPOCHS, strict=True)
    ]
    return train_paper(
        config.model_copy(update={"phases": phases}), data, folder / "checkpoint.safetensors"
    )[0]


def figures(model: Model, batches: list) -> dict[str, float]:
    """Return what a model is judged by."""
    summary = evaluate(model, batches).errors.summary()
    return {key: summary[key] for key in ("mean_percent", "p97_percent", "worst_percent")}


def picture(rows: list[dict]) -> Figure:
    """Return the curves."""
    figure = Figure(figsize=(4.6, 3.0), dpi=style.DPI, layout="constrained")
    ax = figure.subplots()
    for name, colour in zip(WORDS, COLOURS, strict=True):
        part = sorted((r for r in rows if r["model"] == name), key=lambda r: r["trials"])
        if part:
            x, y = ([r[k] for r in part] for k in ("trials", "mean_percent"))
            ax.plot(x, y, "o-", color=colour, lw=1.2, ms=3)
            ax.annotate(
                WORDS[name], (x[-1], y[-1]), (5, 0), textcoords="offset points", va="center",
                color=colour, fontsize=8,
            )  # fmt: skip
    ax.set(xscale="log", yscale="log", xlabel="trials", xlim=(40, 6000))
    ax.set_ylabel("mean vertex error, % of dimension")
    ax.set_xticks(SIZES, [str(n) for n in SIZES])
    ax.minorticks_off()
    ax.set_yticks([0.1, 0.2, 0.5, 1, 2, 5, 10], ["0.1", "0.2", "0.5", "1", "2", "5", "10"])
    ax.spines[["top", "right"]].set_visible(False)
    return style.ink(figure)


def main() -> None:
    """Train what is not there yet, and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--data", type=Path, default=Path("data/default.h5"))
    parser.add_argument("--runs", type=Path, default=Path("data/curve"))
    parser.add_argument("--models", nargs="*", default=["beams", "equilibrium", "network", "paper"])
    parser.add_argument("--sizes", nargs="*", type=int, default=SIZES)
    parser.add_argument("--report", action="store_true", help="of what is there; train nothing")
    options = parser.parse_args()
    if not options.report:
        data = read_dataset(options.data, "train")
        batches = for_testing(read_dataset(options.data, stress=False))
        for name in options.models:
            for size in options.sizes:
                folder = options.runs / f"{name}-{size}"
                if (folder / "figures.json").exists():
                    continue
                model = trained(name, size, data, folder)
                result = {"model": name, "trials": size, **figures(model, batches)}
                with replacing(folder / "figures.json") as temporary:
                    temporary.write_text(json.dumps(result) + "\n", "utf-8")
                print(result, flush=True)
    rows = [json.loads(f.read_text("utf-8")) for f in options.runs.glob("*/figures.json")]
    paper = read_config("paper")
    assert isinstance(paper, PaperConfig)
    report = Report("curve", "Learning curves")
    report.say(
        "Mean vertex error of the last frame over the 400 test trials, % of dimension, by the "
        f"number of trials learnt from; 8 of them set aside. Both: {UPDATES:,} updates each, no "
        "polish. Network only: the same kind of network with four rounds instead of two, asked "
        f"for the poses themselves, {ALONE_STAGE.updates:,} updates. The paper's network: "
        f"{sum(EPOCHS)} epochs instead of the {sum(p.epochs for p in paper.phases)} of its "
        "configuration, batches in proportion to the trials, 4 at least. One seed. "
        "Below each mean, the 97th percentile."
    )
    sizes = sorted({r["trials"] for r in rows})
    table = []
    for name, words in WORDS.items():
        found = {r["trials"]: r for r in rows if r["model"] == name}
        if not found:
            continue
        for key, tail in (("mean_percent", ""), ("p97_percent", ", 97 %")):
            table.append(
                [words + tail, *(f"{found[n][key]:.2f}" if n in found else "" for n in sizes)]
            )
    report.table(["model", *map(str, sizes)], table)
    path = Path("docs/pictures/curve.png")
    with replacing(path) as temporary:
        picture(rows).savefig(temporary)
    report.say("![Learning curves](../pictures/curve.png)")
    report.save()


if __name__ == "__main__":
    main()
