"""Text of drawings in the encodings that programs write."""

from simulearn.errors import InputError
from simulearn.files import marked_encoding


def decoded(data: bytes) -> str:
    """Return text, which may begin with a byte order mark; line ends become those of Unix.

    Raises:
        InputError: the bytes are no text.
    """
    encoding = marked_encoding(data)
    if encoding is None and data[:4].count(0) == 2 and len(data) > 3:  # UTF-16 without a mark
        encoding = "utf-16-le" if data[1] == 0 else "utf-16-be"
    for name in (encoding,) if encoding else ("utf-8", "cp1252"):
        try:
            text = data.decode(name)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text.replace("\r\n", "\n").replace("\r", "\n")
    raise InputError("is neither a drawing nor text", "format")
