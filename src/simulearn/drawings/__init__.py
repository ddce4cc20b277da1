"""Drawings of other programs: read, mended and made into a grid, with every step reported."""
