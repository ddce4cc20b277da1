"""What a machine did with a file, and what would go wrong."""

from dataclasses import dataclass, field
from typing import Any

from virtual_state import State

MOST = 200  # dangers that are kept


@dataclass
class Danger:
    """What would go wrong, where."""

    what: str
    line: int
    text: str
    why: str

    def __str__(self) -> str:
        return f"{self.what} in line {self.line} ({self.text}): {self.why}"


@dataclass
class Trace:
    """What a machine did with a file.

    Attributes:
        dangers: what would go wrong.
        beads: (n, 6) x0 y0 x1 y1 z and filament (mm) of moves that print.
        fed: filament fed less drawn back over the whole file, mm.
        first: state before the first bead.
        last: state at the end.
        hidden: how often a quantity was used that a macro has hidden.
        progress: of M73, %.
        waits: (line, C) where the machine waited for the nozzle.
        line: which is read.
        text: of that line.
    """

    dangers: list[Danger] = field(default_factory=list)
    beads: Any = None
    fed: float = 0.0
    first: dict[str, Any] = field(default_factory=dict)
    last: State | None = None
    hidden: int = 0
    progress: list[float] = field(default_factory=list)
    waits: list[tuple[int, float]] = field(default_factory=list)
    line: int = 0
    text: str = ""

    def danger(self, what: str, why: str) -> None:
        """Note a danger in the line that is read."""
        if len(self.dangers) < MOST:
            self.dangers.append(Danger(what, self.line, self.text.strip()[:60], why))

    @property
    def kinds(self) -> set[str]:
        """The names of the dangers."""
        return {danger.what for danger in self.dangers}
