"""SimuLearn: the shape a flat 4D-printed grid takes in hot water."""

__version__ = "0.1.0"
