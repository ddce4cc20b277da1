"""The two ways in which a request can fail: its input is wrong, or its computation did.

Both are written for the person who asked: what is wrong, where, and what would be right.
"""


class InputError(ValueError):
    """The input is wrong (exit code 1 of the command line)."""


class ComputationError(RuntimeError):
    """The input is right, but the computation failed (exit code 3 of the command line)."""
