"""Mechanics in double precision, as the models run it."""

import jax
import pytest


@pytest.fixture(scope="module", autouse=True)
def double_precision():
    with jax.enable_x64(True):
        yield
