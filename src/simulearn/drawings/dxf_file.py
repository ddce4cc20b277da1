"""A DXF file as a document of ezdxf: in any encoding, and repaired where it is damaged."""

import io
import logging
import re
from itertools import islice
from typing import Any

from simulearn.drawings.dxf_text import as_text, completed, is_binary
from simulearn.errors import InputError

# More than can be read in a reasonable time; a grid has far fewer.
MAX_THINGS = 200_000
MAX_POINTS = 500_000

_CODEPAGE = re.compile(rb"\$DWGCODEPAGE\s+3\s+(\S+)")
_VERSION = re.compile(rb"\$ACADVER\s+1\s+(AC\d{4})")
# What ezdxf repairs of entities, by the numbers of ezdxf.audit.AuditError; it repairs much else
# that no line depends on.
_LOSSES = {8, 11, 16, 103, 104, 108, 116, 117, *range(210, 229)}
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
    text = as_text(data) if is_binary(data) else _text(data)
    if not re.search(r"^[ \t]*0[ \t]*\n[ \t]*SECTION[ \t]*$", text[:100_000], re.MULTILINE):
        raise InputError("this is no DXF file: no SECTION begins in it", "dxf-broken")
    _refuse_large(text)
    from ezdxf.document import Drawing

    text = completed(text)
    try:
        return Drawing.read(io.StringIO(text)), []
    except Exception as error:  # a damaged file fails in any way
        return _recovered(text, error)


def _refuse_large(text: str) -> None:
    """Refuse a file of more things or points than can be read in a reasonable time."""
    things = points = 0
    for code in islice(io.StringIO(text), 0, None, 2):
        things += code.strip() == "0"
        points += code.strip() == "10"  # the x of a point
    if things > MAX_THINGS or points > MAX_POINTS:
        raise InputError(
            "the drawing has too many things or points; keep only the lines of the grid",
            "too-large",
        )


def _recovered(text: str, why: Exception) -> tuple[Any, list[str]]:
    """Read what can be read of a damaged file, as text."""
    from ezdxf import recover

    text = _ended(text)
    # ezdxf looks for the encoding by itself: as escapes the letters are safe in each.
    stream = io.BytesIO("".join(map(_escaped, text)).encode("ascii"))
    try:
        found, audit = recover.read(stream, errors="replace")
    except Exception as error:  # a damaged file fails in any way
        raise InputError(f"the DXF file is damaged: {_reason(error)}", "dxf-broken") from None
    if not len(found.modelspace()):
        raise InputError(f"the DXF file is damaged: {_reason(why)}", "dxf-broken")
    messages = [f"The file is damaged ({_reason(why)}); what could be repaired is read."]
    losses = [entry.message for entry in (*audit.errors, *audit.fixes) if entry.code in _LOSSES]
    if losses:
        messages.append(
            f"{len(losses)} things of the damaged file are left out or mended, such as this:"
            f" {_first_line(losses[0])}."
        )
    return found, messages


def _ended(text: str) -> str:
    """End a file that is cut off before the thing in which it breaks off.

    Half a line would be read as one that ends at the origin.
    """
    if text[-200:].split()[-2:] == ["0", "EOF"]:
        return text
    lines = text.split("\n")[:-1]  # the last one may be cut
    last = len(lines) - len(lines) % 2 - 2
    while last > 0 and lines[last].strip() != "0":
        last -= 2
    return "\n".join([*lines[:last], "0", "ENDSEC", "0", "EOF", ""])


def _escaped(letter: str) -> str:
    return letter if letter.isascii() else f"\\U+{min(ord(letter), 0xFFFD):04X}"


def _reason(error: Exception) -> str:
    """Return what ezdxf says about a file; what it stumbles over by chance helps nobody."""
    from ezdxf.lldxf.const import DXFStructureError

    if isinstance(error, DXFStructureError):
        return _first_line(error)
    return "its parts do not fit together"


def _first_line(error: object) -> str:
    """Return what an error says, short and fit for a terminal: it may quote what is broken."""
    line = " ".join(str(error).removeprefix("DXFStructureError: ").split())
    printable = "".join(letter for letter in line if letter.isprintable())
    return printable[:120].rstrip(".")


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
