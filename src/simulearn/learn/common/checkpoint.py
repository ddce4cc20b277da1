"""Checkpoints: all that a run needs to go on as if it had never stopped, in one file.

The file is a safetensors file, replaced in one step after every epoch; what it was made for
stands in its header.
"""

import json
from pathlib import Path
from typing import Any, TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save_file

from simulearn.errors import InputError
from simulearn.files import replacing

T = TypeVar("T")


def save(path: Path, tree: Any, header: dict[str, Any]) -> None:
    """Write arrays of a tree, and plain data."""
    leaves = jax.tree.leaves(tree)
    arrays = {f"{k:05d}": np.asarray(leaf) for k, leaf in enumerate(leaves)}
    with replacing(path) as temporary:
        save_file(arrays, temporary, {"header": json.dumps(header)})


def header(path: Path) -> dict[str, Any]:
    """Return the plain data of a checkpoint.

    Raises:
        InputError: it is not one.
    """
    try:
        with safe_open(path, "numpy") as file:
            content: dict[str, Any] = json.loads(file.metadata()["header"])
            return content
    except (SafetensorError, OSError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path}: is not a checkpoint; delete it to begin anew") from error


def load(path: Path, tree: T) -> T:
    """Return a tree of the same shape with the arrays of a checkpoint.

    Raises:
        InputError: the arrays have other shapes.
    """
    leaves, shape = jax.tree.flatten(tree)
    try:
        with safe_open(path, "numpy") as file:
            arrays = [file.get_tensor(f"{k:05d}") for k in range(len(leaves))]
    except (SafetensorError, OSError) as error:
        raise InputError(f"{path}: is not a checkpoint; delete it to begin anew") from error
    for array, leaf in zip(arrays, leaves, strict=True):
        if array.shape != np.shape(leaf):
            raise InputError(f"{path}: belongs to another architecture; delete it to begin anew")
    filled: T = jax.tree.unflatten(shape, [jnp.asarray(a) for a in arrays])
    return filled
