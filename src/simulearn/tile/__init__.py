"""Covering a surface with modules: patches, tasks that share borders, what is alike."""
