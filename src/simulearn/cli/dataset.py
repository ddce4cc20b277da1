"""Commands about data sets: generate, pack, info."""
