"""DXF as the text that ezdxf reads: of binary files, and of files that lack what it needs."""

import re

from simulearn.errors import InputError

_MAX_GROUPS = 5_000_000
_BINARY = b"AutoCAD Binary DXF\r\n\x1a\x00"

# Things that ezdxf reads only where a group 100 marks their part of the data. Files written by
# hand or by small programs often have none.
_MARKS = {
    "HATCH": "AcDbHatch",
    "LEADER": "AcDbLeader",
    "LWPOLYLINE": "AcDbPolyline",
    "MLINE": "AcDbMline",
    "MTEXT": "AcDbMText",
    "SPLINE": "AcDbSpline",
}
_KINDS = "|".join(_MARKS)
# One of them without the mark that all things have: pairs of lines, up to the next thing.
_UNMARKED = re.compile(
    rf"^ *0\n *({_KINDS}) *\n((?:(?! *0 *\n| *100 *\n *AcDbEntity).*\n.*\n)*)(?= *0 *\n)",
    re.MULTILINE,
)
# Things that R12 did not know: ezdxf reads only half of them in files of R12 or of no version.
_LATER = re.compile(rf"^ *0\n *(?:{_KINDS}|ELLIPSE) *$", re.MULTILINE)
_VERSION = re.compile(r"(\$ACADVER *\n *1 *\n *)(AC10\d\d)")
_HEADER = re.compile(r"^ *0 *\n *SECTION *\n *2 *\n *HEADER *\n", re.MULTILINE)
_R2000 = "AC1015"
# Groups that all things have: handle, linetype, layer, colour, visibility and so on.
_COMMON = {"5", "6", "8", "48", "60", "62", "67", "330", "370", "420", "430", "440"}


def is_binary(data: bytes) -> bool:
    """Return whether a file is binary DXF."""
    return data.startswith(_BINARY)


def as_text(data: bytes) -> str:
    """Return a binary file as text, up to where it is cut off.

    Args:
        data: the file.

    Raises:
        InputError: it is too large.
    """
    from ezdxf.lldxf.tagger import binary_tags_loader

    lines: list[str] = []
    try:
        for tag in binary_tags_loader(data, errors="replace"):
            value = tag.value.hex() if isinstance(tag.value, bytes) else str(tag.value)
            if len(lines) > _MAX_GROUPS:
                break
            lines.append(f"{tag.code}\n{' '.join(value.splitlines())}\n")
    except Exception:  # a file that is cut off fails in any way; what came before is whole
        pass
    if len(lines) > _MAX_GROUPS:
        raise InputError("the drawing is too large; keep only the lines of the grid", "too-large")
    return "".join(lines)


def completed(text: str) -> str:
    r"""Return a file with the marks and the version that ezdxf needs.

    Args:
        text: of the file, its lines ended by "\n".
    """
    if not _LATER.search(text):
        return text
    text = _UNMARKED.sub(_marked, text)
    version = _VERSION.search(text)
    if version is None:
        named = f"9\n$ACADVER\n1\n{_R2000}\n"
        head = _HEADER.search(text)
        if head is None:
            return f"0\nSECTION\n2\nHEADER\n{named}0\nENDSEC\n{text}"
        return text[: head.end()] + named + text[head.end() :]
    if version[2] < _R2000:
        return _VERSION.sub(rf"\g<1>{_R2000}", text, count=1)
    return text


def _marked(thing: re.Match[str]) -> str:
    lines = thing[2].splitlines(keepends=True)
    common: list[str] = []
    rest: list[str] = []
    for code, value in zip(lines[::2], lines[1::2], strict=True):
        if code.strip() != "100":
            (common if code.strip() in _COMMON else rest).append(code + value)
    head = f"0\n{thing[1]}\n100\nAcDbEntity\n{''.join(common)}"
    return f"{head}100\n{_MARKS[thing[1]]}\n{''.join(rest)}"
