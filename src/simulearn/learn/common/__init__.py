"""What all models share: their interface, bundles, evaluation, and the first frame."""
