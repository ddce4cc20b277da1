"""The pages of the public modules; a name of a page is followed by what it shows.

Each page has directives of mkdocstrings, which reads signatures and docstrings from the source when
the site is built. What a package offers is its `__all__`.
"""

from importlib import import_module

FOLDER = "reference/python"
# Page -> module whose `__all__` counts, or names where several modules make one page.
PAGES: dict[str, str | list[str]] = {
    "simulearn": "simulearn",
    "grid": "simulearn.grid",
    "material": "simulearn.material",
    "simulate": "simulearn.simulate",
    "inverse": "simulearn.inverse",
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
        "simulearn.learn.common.bundle.save_bundle",
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
    parts = [
        f"# {module}\n\n::: {module}\n    options: {{members: false, show_root_heading: false}}\n"
    ]
    parts += [f"\n::: {one}\n" for one in names]
    return "".join(parts)


def _public(module: str) -> list[str]:
    """Return what a module offers: classes and functions, without constants."""
    found = import_module(module)
    return [name for name in found.__all__ if callable(getattr(found, name))]
