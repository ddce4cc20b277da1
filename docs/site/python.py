"""The pages of the public modules; a name of a page is followed by what it shows.

Each page has directives of mkdocstrings, which reads signatures and docstrings from the source when
the site is built. What a package offers is its `__all__`.
"""

from importlib import import_module

FOLDER = "reference/python"
# Page -> module whose `__all__` counts, or names where several modules make one page.
PAGES: dict[str, str | list[str]] = {
    "simulearn": [
        "simulearn.simulate.calls.simulate",
        "simulearn.simulate.calls.validate",
        "simulearn.simulate.calls.warm",
        "simulearn.errors.InputError",
        "simulearn.errors.ComputationError",
        "simulearn.errors.CancelledError",
        "simulearn.errors.Message",
    ],
    "grid": "simulearn.grid",
    "material": "simulearn.material",
    "simulate": "simulearn.simulate",
    "inverse": "simulearn.inverse",
    "tile": "simulearn.tile",
    "surfaces": "simulearn.surfaces",
    "fabricate": "simulearn.fabricate",
    "drawings": [
        "simulearn.drawings.importing.imported",
        "simulearn.drawings.importing.Options",
        "simulearn.drawings.importing.Imported",
        "simulearn.drawings.layers.LayerUse",
        "simulearn.drawings.report.Mend",
        "simulearn.drawings.units.UnitError",
    ],
    "interop": "simulearn.interop",
    "dataset": "simulearn.dataset",
    "learn": [
        "simulearn.learn.common.bundle.bundle_of",
        "simulearn.learn.common.bundle.Bundle",
        "simulearn.learn.common.bundle.Card",
        "simulearn.learn.common.saving.save_bundle",
        "simulearn.learn.common.model.Model",
        "simulearn.learn.common.model.Designs",
        "simulearn.learn.common.model.Frames",
        "simulearn.learn.common.model.last_frame",
        "simulearn.learn.common.evaluate.evaluate",
        "simulearn.learn.common.evaluate.Evaluation",
        "simulearn.learn.common.evaluate.for_testing",
        "simulearn.learn.config.read_config",
        "simulearn.learn.config.config_of",
        "simulearn.learn.run.run",
        "simulearn.learn.equilibrium.slopes.slopes",
        "simulearn.learn.equilibrium.slopes.Slopes",
    ],
    "fea": "simulearn.fea",
    "show": "simulearn.show",
    "outputs": ["simulearn.outputs.write", "simulearn.outputs.check"],
}


def pages() -> dict[str, str]:
    """Return the text of each page by its place in the site."""
    return {f"{FOLDER}/{name}.md": _page(name) for name in PAGES}


def _page(name: str) -> str:
    shown = PAGES[name]
    module = "simulearn" if name == "simulearn" else f"simulearn.{name}"
    names = [f"{shown}.{one}" for one in _public(shown)] if isinstance(shown, str) else shown
    title = (
        f"# {module}\n\n::: {module}\n    options: {{members: false, show_root_heading: false}}\n"
    )
    elsewhere = _elsewhere() if name == "simulearn" else ""
    return title + elsewhere + "".join(_directive(one) for one in names)


def _directive(name: str) -> str:
    """Return what shows a function or class, under the name by which it is imported."""
    short = name.rpartition(".")[2]
    if name.startswith(("simulearn.simulate.calls.", "simulearn.errors.")):
        return f"\n::: {name}\n    options: {{heading: simulearn.{short}, toc_label: {short}}}\n"
    return f"\n::: {name}\n    options: {{toc_label: {short}}}\n"


def _elsewhere() -> str:
    """Return where what `simulearn` offers besides is described."""
    import simulearn

    rows = []
    for name in simulearn.__all__:
        page = simulearn.PLACES.get(name, "").removeprefix("simulearn.")
        if page in PAGES and callable(getattr(simulearn, name)):
            rows.append(f"| `simulearn.{name}` | [simulearn.{page}]({page}.md) |\n")
    return "\nFrom other modules come:\n\n| name | described with |\n| --- | --- |\n" + "".join(
        rows
    )


def _public(module: str) -> list[str]:
    """Return what a module offers: classes and functions, without constants."""
    found = import_module(module)
    return [name for name in found.__all__ if callable(getattr(found, name))]
