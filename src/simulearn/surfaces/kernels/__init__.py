"""Kernels of surfaces and curves: a tree of boxes over triangles, and what is asked of it."""
