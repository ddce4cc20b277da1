"""Native kernels of collisions: one set for every grid, without the interpreter's lock."""
