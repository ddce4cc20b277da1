"""A running studio and a browser for the tests of the page."""

import os

import pytest

import browsing

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


@pytest.fixture(scope="session")
def browser():
    required("chromium", browsing.chromium_path() is not None)
    with browsing.chromium() as one:
        yield one


@pytest.fixture
def page(browser, request):
    """A page of a new visitor; whatever it writes to the console as an error fails the test."""
    options = getattr(request, "param", {})
    context = browser.new_context(**({"viewport": {"width": 1440, "height": 900}} | options))
    context.set_default_timeout(15_000)
    one = context.new_page()
    wrong = []
    one.on("pageerror", lambda error: wrong.append(str(error)))
    one.on("console", lambda m: wrong.append(m.text) if m.type == "error" else None)
    one.wrong = wrong
    yield one
    context.close()
    assert [text for text in wrong if not any(w in text for w in ERRORS_OF_OTHERS)] == []
