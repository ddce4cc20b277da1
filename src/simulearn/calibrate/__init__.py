"""Fitting a material to measured prints."""
