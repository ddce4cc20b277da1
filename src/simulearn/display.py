"""How objects show themselves in a notebook: by `simulearn.notebook`, loaded when one does."""

from importlib import import_module
from typing import Any


class Displayed:
    """An object that a notebook shows as text, picture or page."""

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        """Return its contents by media type, as Jupyter asks for them."""
        # By name, since what shows an object lies above what it is.
        bundle: dict[str, Any] = import_module("simulearn.notebook").bundle(self, include, exclude)
        return bundle
