"""Surfaces and curves that designers bring: reading, mending, closest points."""
