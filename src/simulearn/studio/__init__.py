"""The design studio: a page in the browser, and the REST API that answers it and other programs."""

from simulearn.studio.app import create_app

__all__ = ["create_app"]
