"""How grids and results show themselves in a notebook."""
