"""Comparing a measured print with the simulation."""
