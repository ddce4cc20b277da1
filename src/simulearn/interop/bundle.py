"""Modules of JavaScript as one script, so that a page needs no address to load them from.

Only what the page's own modules use is known: named imports and exports at the start of a line,
and libraries that end with one list of exports. Anything else is an error, never a broken page.
"""

import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

IMPORT = re.compile(r'^import \{([^}]*)\} from "([^"]+)";\n', re.MULTILINE)
AGAIN = re.compile(r'^export \{([^}]*)\} from "([^"]+)";\n', re.MULTILINE)
EXPORT = re.compile(r"^export ((?:async )?function|const|class) (\w+)", re.MULTILINE)
LAST = re.compile(r"export\s*\{([^}]*)\}\s*;?\s*(?://# sourceMappingURL=\S*\s*)?\Z")
LEFT = re.compile(r"^\s*(?:import|export)\b|\bimport\s*\(|\bimport\.meta\b", re.MULTILINE)


class Bundle:
    """Modules and what they import, each once, in an order in which they can run.

    Args:
        roots: beginnings of absolute addresses, and the folders that they stand for.
        files: absolute addresses that stand for a file.
        instead: modules, and what is taken in their place.
    """

    def __init__(
        self,
        roots: Mapping[str, Path] = MappingProxyType({}),
        files: Mapping[str, Path] = MappingProxyType({}),
        instead: Mapping[Path, Path] = MappingProxyType({}),
    ) -> None:
        self._roots, self._files = roots, files
        self._instead = {a.resolve(): b.resolve() for a, b in instead.items()}
        self._names: dict[Path, str] = {}
        self._open: set[Path] = set()
        self._parts: list[str] = []

    def script(self, entry: Path) -> str:
        """Return a script that runs a module after all that it imports.

        Raises:
            ValueError: a module has a form that is not known here, or imports itself.
        """
        self._add(entry.resolve())
        return '(() => {\n"use strict";\n' + "".join(self._parts) + "})();\n"

    @property
    def modules(self) -> list[Path]:
        """The files of all modules that were needed, in the order in which they run."""
        return list(self._names)

    def _add(self, path: Path) -> str:
        if path in self._open:
            raise ValueError(f"{path} is in a cycle of imports")
        if path not in self._names:
            self._open.add(path)
            text = path.read_text("utf-8")
            body, exports = self._library(text) if LAST.search(text) else self._module(path, text)
            name = f"m{len(self._names)}"
            result = ", ".join(f"{outer}: {inner}" for outer, inner in exports.items())
            self._parts.append(
                f"const {name} = (() => {{\n{body}\nreturn {{ {result} }};\n}})();\n"
            )
            self._open.remove(path)
            self._names[path] = name
        return self._names[path]

    def _library(self, text: str) -> tuple[str, dict[str, str]]:
        match = LAST.search(text)
        assert match is not None
        return text[: match.start()], _pairs(match[1])

    def _module(self, path: Path, text: str) -> tuple[str, dict[str, str]]:
        exports = {}

        def imported(match: re.Match[str]) -> str:
            names = ", ".join(f"{a}: {b}" for b, a in _pairs(match[1]).items())
            return f"const {{ {names} }} = {self._add(self._place(path, match[2]))};\n"

        def passed_on(match: re.Match[str]) -> str:
            name = self._add(self._place(path, match[2]))
            exports.update({outer: f"{name}.{a}" for outer, a in _pairs(match[1]).items()})
            return ""

        def exported(match: re.Match[str]) -> str:
            exports[match[2]] = match[2]
            return f"{match[1]} {match[2]}"

        text = IMPORT.sub(imported, text)
        text = AGAIN.sub(passed_on, text)
        text = EXPORT.sub(exported, text)
        if found := LEFT.search(text):
            raise ValueError(f"{path}: {found[0].strip()!r} in a form that is not known here")
        return text, exports

    def _place(self, path: Path, address: str) -> Path:
        """Return the file that an address in a module means."""
        if address in self._files:
            return self._files[address]
        found = path.parent / address if address.startswith(".") else None
        for start, folder in self._roots.items():
            if address.startswith(start):
                found = folder / address.removeprefix(start)
        if found is None:
            raise ValueError(f"{path}: {address} is not known here")
        return self._instead.get(found.resolve(), found.resolve())


def _pairs(names: str) -> dict[str, str]:
    """Return {new name: name} of a list such as "a, b as c"."""
    pairs = {}
    for one in filter(None, map(str.strip, names.split(","))):
        name, _, other = one.partition(" as ")
        pairs[other.strip() or name.strip()] = name.strip()
    return pairs
