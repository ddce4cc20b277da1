"""Beams that meet while a grid morphs: which, in which frame, how deep."""
