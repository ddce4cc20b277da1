"""Packages that only some tasks need, by the extra of SimuLearn that installs them."""

import importlib.util

from simulearn.errors import InputError

EXTRAS = {  # package, as it is imported -> extra
    "nicegui": "studio",
    "fastapi": "studio",
    "uvicorn": "studio",
    "rhino3dm": "rhino",
    "ezdxf": "rhino",
    "svgelements": "rhino",
    "tinycss2": "rhino",
    "meshio": "vtk",
    "distributed": "cluster",
    "optuna": "search",
    "cma": "search",
    "jax": "train",
    "equinox": "train",
    "optax": "train",
    "cv2": "photo",
}


def require(what: str, *packages: str) -> None:
    """Make sure that packages are installed; none of them is imported.

    Args:
        what: needs them, with its verb: "DXF files need".
        packages: keys of EXTRAS.

    Raises:
        InputError: one is missing; the message says how to install it.
    """
    for package in packages:
        if importlib.util.find_spec(package) is None:
            raise missing(what, package)


def missing(what: str, package: str) -> InputError:
    """Return the error that says which extra installs a package; see `require`."""
    text = f"{what} the package {package}: pip install 'simulearn[{EXTRAS[package]}]'"
    return InputError(text, "package-missing", package)
