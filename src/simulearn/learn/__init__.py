"""Learned simulators: models, their training, their evaluation, and their bundles."""
