"""The paper's model: a double interaction network that steps from frame to frame."""
