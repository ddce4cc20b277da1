"""Models that solve for equilibrium: beam mechanics, corrected by a small network."""
