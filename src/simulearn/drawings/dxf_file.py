"""A DXF file as a document of ezdxf: text or binary, in any encoding, repaired where damaged."""

import io
import logging
import re
from typing import Any

from simulearn.errors import InputError

_BINARY = b"AutoCAD Binary DXF\r\n\x1a\x00"
_CODEPAGE = re.compile(rb"\$DWGCODEPAGE\s+3\s+(\S+)")
_VERSION = re.compile(rb"\$ACADVER\s+1\s+(AC\d{4})")
_UNICODE = "AC1021"  # from this version on a file is UTF-8


def document(data: bytes) -> tuple[Any, list[str]]:
    """Return a file as ezdxf reads it, and what was repaired.

    Args:
        data: the file.

    Raises:
        InputError: it is no DXF file, or too damaged.
    """
    # Its remarks would go to the terminal where nobody has set up logging.
    logging.getLogger("ezdxf").addHandler(logging.NullHandler())
    if re.match(rb"AC\d\d\d\d", data):
        raise InputError("this is a DWG file; save it as DXF", "dxf-dwg")
    if data.startswith(_BINARY):
        return _binary(data)
    text = _text(data)
    if not re.search(r"^\s*0\s*\n\s*SECTION\s*$", text[:100_000], re.MULTILINE):
        raise InputError("this is no DXF file: no SECTION begins in it", "dxf-broken")
    return _ascii(text)


def _ascii(text: str) -> tuple[Any, list[str]]:
    from ezdxf.document import Drawing

    try:
        return Drawing.read(io.StringIO(text)), []
    except Exception as error:  # a damaged file fails in any way
        return _recovered(text, error)


def _binary(data: bytes) -> tuple[Any, list[str]]:
    from ezdxf.document import Drawing
    from ezdxf.lldxf.tagger import binary_tags_loader

    try:
        return Drawing.load(binary_tags_loader(data, errors="replace")), []
    except Exception as error:  # a damaged file fails in any way
        lines = []
        try:
            for tag in binary_tags_loader(data, errors="replace"):
                value = tag.value.hex() if isinstance(tag.value, bytes) else tag.value
                lines.append(f"{tag.code}\n{value}\n")
        except Exception:  # what came before is whole
            pass
        return _recovered("".join(lines), error)


def _recovered(text: str, why: Exception) -> tuple[Any, list[str]]:
    """Read what can be read of a damaged file, as text."""
    from ezdxf import recover

    # ezdxf looks for the encoding by itself: as escapes the letters are safe in each.
    stream = io.BytesIO("".join(map(_escaped, text)).encode("ascii"))
    try:
        found, audit = recover.read(stream, errors="replace")
    except Exception as error:  # a damaged file fails in any way
        raise InputError(f"the DXF file is damaged: {_first_line(error)}", "dxf-broken") from None
    losses = [*audit.errors, *audit.fixes]
    messages = [f"The file is damaged ({_first_line(why)}); read is what could be repaired."]
    messages += [f"Repaired: {_first_line(loss.message)}" for loss in losses[:5]]
    if len(losses) > 5:
        messages.append(f"{len(losses) - 5} more places were repaired.")
    return found, messages


def _escaped(letter: str) -> str:
    return letter if letter.isascii() else f"\\U+{min(ord(letter), 0xFFFD):04X}"


def _first_line(error: object) -> str:
    lines = str(error).strip().splitlines()
    return lines[0].removeprefix("DXFStructureError: ").rstrip(".") if lines else "no end"


def _text(data: bytes) -> str:
    """Decode a file, with line ends as Python has them."""
    encoding = _encoding(data)
    text = data.removeprefix(b"\xef\xbb\xbf").decode(encoding, errors="replace")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _encoding(data: bytes) -> str:
    """Return the encoding of a file's text.

    A file that is UTF-8 throughout is taken for it, whatever it says, unless it names a code page
    of its own: programs often write UTF-8 below a head that names the usual one.
    """
    from ezdxf.tools.codepage import toencoding

    version, codepage = _VERSION.search(data), _CODEPAGE.search(data)
    named = toencoding(codepage[1].decode("ascii", "replace")) if codepage else "cp1252"
    if named == "cp1252" or (version and version[1].decode() >= _UNICODE):
        try:
            data.decode("utf-8")
        except UnicodeDecodeError:
            return named
        return "utf-8"
    return named
