"""How a request can fail: its input is wrong, its computation did not succeed, it was cancelled.

All are written for the person who asked: what is wrong, where, and what would be right. Programs go
by `code` and `where`; no message speaks of one program's switches.
"""

import threading
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True)
class Message:
    """Something to say about a design or a request.

    Attributes:
        code: short name of the rule, for programs.
        where: "joint 3", "beam 7", "grid", a key or a file.
        message: what is wrong, and what would be right.
    """

    code: str
    where: str
    message: str


class InputError(ValueError):
    """The input is wrong (exit code 1 of the command line).

    Args:
        text: what is wrong, where, and what would be right.
        code: short name of what is wrong.
        where: the place: a key, joint, beam or file.
        messages: all that is wrong, where there is more than one.
    """

    def __init__(
        self, text: str, code: str = "input", where: str = "", messages: Sequence[Message] = ()
    ) -> None:
        super().__init__(text)
        self.code, self.where, self.messages = code, where, tuple(messages)


class ComputationError(RuntimeError):
    """The input is right, but the computation failed (exit code 3 of the command line).

    Args:
        text: what failed.
        code: short name of what failed.
        where: the place: a frame, joint or beam.
        hint: what may help.
    """

    def __init__(
        self, text: str, code: str = "computation", where: str = "", hint: str = ""
    ) -> None:
        super().__init__(text)
        self.code, self.where, self.hint = code, where, hint


class CancelledError(Exception):
    """The computation was stopped by whoever asked for it."""


class Cancel(Protocol):
    """A token that can stop a computation, such as `threading.Event`."""

    def is_set(self) -> bool:
        """Return whether the computation shall stop."""
        ...


class Either:
    """A token that is set here, or by whoever can cancel all of it.

    Args:
        other: the token of all of it.
    """

    def __init__(self, other: Cancel | None) -> None:
        self._own, self._other = threading.Event(), other

    def set(self) -> None:
        """Let what goes by it stop."""
        self._own.set()

    def is_set(self) -> bool:
        """Return whether the computation shall stop."""
        return self._own.is_set() or (self._other is not None and self._other.is_set())


def stop_if(cancel: Cancel | None) -> None:
    """Raise CancelledError if a token says so."""
    if cancel is not None and cancel.is_set():
        raise CancelledError("cancelled")
