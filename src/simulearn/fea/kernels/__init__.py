"""Native kernels of the finite elements: one compilation for all grids, layouts and laws.

`law` is the response of a material point, `brick` that of a brick, `front` the elimination of
unknowns; `entries` is what Python calls. Arrays are contiguous, of float64 and int64.
"""
