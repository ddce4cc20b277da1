"""Native kernels of beam mechanics: one set for every grid, without the interpreter's lock."""
