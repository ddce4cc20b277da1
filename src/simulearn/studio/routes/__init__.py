"""The routes of the REST API; each module has a `router`."""
