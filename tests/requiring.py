"""Programs that some tests need: skipped where they are missing, a failure where they must be."""

import os

import pytest


def required(what: str, found: bool) -> None:
    """Skip a test whose program is not installed, or fail where all must be.

    Args:
        what: name of the program, as in SIMULEARN_REQUIRE.
        found: whether it is there.
    """
    if found:
        return
    if what in os.environ.get("SIMULEARN_REQUIRE", ""):
        pytest.fail(f"{what} is required here, but was not found")
    pytest.skip(f"{what} is not installed")
