"""Grids of beams between joints: poses, a fitted section, equilibrium, and its frames."""
