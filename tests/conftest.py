"""What tests of several folders use."""

import sys

import pytest

from simulearn import cli
from simulearn.compiled import make_room


@pytest.fixture(scope="module", autouse=True)
def room():
    """Tests compile more kernels of their own than one process may hold."""
    make_room()


@pytest.fixture
def run(monkeypatch, capsys):
    """Return a function that runs a command line: (exit code, stdout, stderr)."""

    def run(*words):
        monkeypatch.setattr(sys, "argv", ["simulearn", *map(str, words)])
        try:
            cli.main()
            code = 0
        except SystemExit as stop:
            code = stop.code or 0
        return code, *capsys.readouterr()

    return run
