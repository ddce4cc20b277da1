"""Kernels of surfaces and curves: a tree of boxes over triangles, and its queries."""
