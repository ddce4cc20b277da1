"""A running studio and a browser for the tests of the page."""

import os
import shutil

import pytest

import browsing

PATIENCE = 15_000  # ms that something may take on a busy machine
ERRORS_OF_OTHERS = ("favicon",)


def required(what: str, found: bool) -> None:
    """Skip a test whose program is not installed, or fail where all must be."""
    if found:
        return
    if what in os.environ.get("SIMULEARN_REQUIRE", ""):
        pytest.fail(f"{what} is required here, but was not found")
    pytest.skip(f"{what} is not installed")


@pytest.fixture(scope="session")
def studio(tmp_path_factory):
    """A studio in a process of its own, and its address."""
    with browsing.running(tmp_path_factory.mktemp("documents")) as one:
        yield one


@pytest.fixture(scope="module")  # while it is open, its loop runs in this thread
def browser():
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


@pytest.fixture
def page(visit, request):
    """A page of a new visitor."""
    return visit(**getattr(request, "param", {}))


@pytest.fixture(scope="session")
def node():
    """The program node, which runs the page's functions."""
    found = shutil.which("node")
    required("node", found is not None)
    return found
