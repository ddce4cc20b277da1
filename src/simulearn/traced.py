"""Traced functions, kept between runs: tracing a simulator takes seconds, reading it back does not.

What a function traces to, for the shapes of its arguments, is kept as StableHLO beside the compiled
kernels (see `compiled`). Its file is named by all that it follows from: the traced source, as it
was at import, the versions of JAX, the platform, the name of the function and the shapes. What
cannot be read is made anew; where nothing can be written, every run traces for itself.
"""

import hashlib
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import jax
import jaxlib
from jax import export

from simulearn.compiled import make_room
from simulearn.errors import InputError
from simulearn.files import replacing

PACKAGE = Path(__file__).parent
TRACED = ("mechanics", "learn/equilibrium")  # folders whose functions are traced
MOST = 64  # compiled functions kept in memory
Call = Callable[[list[Any]], Any]


class Traced:
    """A function that is compiled for the shapes it meets, and traced once on a machine.

    Args:
        name: of the function; two that share it and their shapes must do the same.
        function: of any trees of arrays, to tuples, lists, dictionaries and arrays.
    """

    def __init__(self, name: str, function: Callable[..., Any]) -> None:
        self.name, self.function = name, function
        self._calls: dict[Any, Call] = {}
        self._finding = threading.Lock()

    def __call__(self, *args: Any) -> Any:
        """Return what the function returns."""
        leaves, tree = jax.tree.flatten(args)
        shapes = tuple((x.shape, x.dtype) for x in leaves)
        if (tree, shapes) not in self._calls:
            with self._finding:  # other threads wait rather than compile the same
                if (tree, shapes) not in self._calls:
                    call = self._found(leaves, tree, shapes)
                    result = call(leaves)
                    self._keep((tree, shapes), call)
                    return result
        return self._calls[tree, shapes](leaves)

    def _keep(self, key: Any, call: Call) -> None:
        """Keep a compiled function; of many, those met first are forgotten."""
        while len(self._calls) >= MOST:
            self._calls.pop(next(iter(self._calls)))
        self._calls[key] = call

    def _found(self, leaves: list[Any], tree: Any, shapes: Any) -> Call:
        """Return the compiled function, from what was kept of it or traced now."""
        make_room()
        fresh = jax.jit(lambda flat: self.function(*jax.tree.unflatten(tree, flat)))
        folder = jax.config.values["jax_compilation_cache_dir"]
        if not folder:
            return fresh
        key = (SOURCE, self.name, str(tree), shapes, jax.default_backend())
        name = hashlib.sha256(repr(key).encode()).hexdigest()
        file = Path(folder) / "traced" / f"{name}.stablehlo"
        with suppress(OSError, ValueError):
            return jax.jit(export.deserialize(bytearray(_checked(file.read_bytes()))).call)
        like = [jax.ShapeDtypeStruct(x.shape, x.dtype) for x in leaves]
        traced = export.export(fresh)(like)
        with suppress(OSError, InputError):
            file.parent.mkdir(parents=True, exist_ok=True)
            with replacing(file) as temporary:
                content = bytes(traced.serialize())
                temporary.write_bytes(hashlib.sha256(content).digest() + content)
        return jax.jit(traced.call)


def _checked(content: bytes) -> bytes:
    """Return what follows the hash in the first 32 bytes, if it has that hash."""
    if hashlib.sha256(content[32:]).digest() != content[:32]:
        raise ValueError("damaged")
    return content[32:]


def source() -> str:
    """Return a hash of the source that is traced and of the versions of JAX, as of now."""
    digest = hashlib.sha256(f"{jax.__version__} {jaxlib.__version__}".encode())
    for file in sorted(f for folder in TRACED for f in (PACKAGE / folder).rglob("*.py")):
        name = file.relative_to(PACKAGE).as_posix()
        digest.update(name.encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


SOURCE = source()  # at import: what runs is what was read then
