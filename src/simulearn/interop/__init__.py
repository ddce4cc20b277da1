"""Results for other programs, by the ending of a file's name."""

from simulearn.interop.formats import FORMATS, check_outputs, format_of, write

__all__ = ["FORMATS", "check_outputs", "format_of", "write"]
