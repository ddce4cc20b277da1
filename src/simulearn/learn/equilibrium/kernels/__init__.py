"""Native kernels of the networks: features, layers, outputs, stresses."""
