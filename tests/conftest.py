"""What tests of several folders use."""

import os
import shutil
import sys

import jax
import pytest

from requiring import required
from simulearn import cli
from simulearn.compiled import make_room

PATIENCE = 15_000  # ms that something may take on a busy machine
ERRORS_OF_OTHERS = ("favicon",)
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"]


@pytest.fixture(scope="session", autouse=True)
def quick_to_compile():
    """Compiling for speed takes longer than what tests compile runs, in their processes too."""
    jax.config.update("jax_disable_most_optimizations", True)
    os.environ["JAX_DISABLE_MOST_OPTIMIZATIONS"] = "1"


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


@pytest.fixture(scope="session")
def node():
    """The program node, which runs the page's functions."""
    found = shutil.which("node")
    required("node", found is not None)
    return found


@pytest.fixture(scope="module")  # while it is open, its loop runs in this thread
def browser():
    import browsing

    required("chromium", browsing.chromium_path() is not None)
    from playwright.sync_api import expect

    expect.set_options(timeout=PATIENCE)
    with browsing.chromium() as one:
        yield one


@pytest.fixture
def forgiven():
    """Texts of errors that a test causes on purpose; it adds them."""
    return []


@pytest.fixture
def visit(browser, forgiven):
    """Return a function that gives a page of a new visitor.

    Whatever a visitor's pages write to the console as an error fails the test: faults of scripts,
    answers of the server that were not expected, what the page's security policy refuses.
    """
    contexts, wrong = [], []

    def visit(**options):
        context = browser.new_context(**({"viewport": {"width": 1440, "height": 900}} | options))
        contexts.append(context)
        context.set_default_timeout(PATIENCE)
        context.on("weberror", lambda error: wrong.append(str(error.error)))
        context.on("console", lambda m: wrong.append(m.text) if m.type == "error" else None)
        return context.new_page()

    yield visit
    for context in contexts:
        context.close()
    mild = (*ERRORS_OF_OTHERS, *forgiven)
    assert [text for text in wrong if not any(words in text for words in mild)] == []


@pytest.fixture(scope="session")
def axe():
    """Return a function that lists what is wrong with a page as it is."""
    script = pytest.importorskip("axe_playwright_python.sync_playwright").Axe().axe_script
    every = {"type": "tag", "values": RULES}
    colours = {"type": "rule", "values": ["color-contrast"]}  # the only difference in the dark

    def wrong(page):
        if not page.evaluate("() => 'axe' in window"):
            page.evaluate(script)
        dark = page.evaluate("() => document.documentElement.dataset.theme") == "dark"
        options = {"runOnly": colours if dark else every, "resultTypes": ["violations"]}
        found = page.evaluate("(options) => axe.run(options)", options)["violations"]
        return [(one["id"], node["html"]) for one in found for node in one["nodes"]]

    return wrong
