"""A running studio and its visitors' pages."""

import pytest

import browsing


@pytest.fixture(scope="session")
def studio(tmp_path_factory):
    """A studio in a process of its own, and its address."""
    with browsing.running(tmp_path_factory.mktemp("documents")) as one:
        yield one


@pytest.fixture
def page(visit, request):
    """A page of a new visitor."""
    return visit(**getattr(request, "param", {}))
