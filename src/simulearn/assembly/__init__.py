"""Several grids put together: where each is, in which order they morph, what touches."""
