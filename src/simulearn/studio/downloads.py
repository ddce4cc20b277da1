"""Names of files that a browser saves: harmless on every system, in any language."""

import re
import unicodedata
from urllib.parse import quote

MOST = 80  # characters of a name, well below what file systems take, also in four bytes each
FORBIDDEN = re.compile(r'[<>:"/\\|?*%]')  # on one system or another
RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?")  # devices on Windows


def safe_stem(name: str, otherwise: str = "grid") -> str:
    """Return a name of a file without its ending, made of what a person called it."""
    text = unicodedata.normalize("NFC", name.encode("utf-8", "ignore").decode())
    text = "".join(c if c.isprintable() else " " for c in text)
    text = " ".join(FORBIDDEN.sub("-", text).split())[:MOST].strip(". ")
    if not text:
        return otherwise
    return f"{text}-" if RESERVED.fullmatch(text) else text


def attachment(file: str) -> dict[str, str]:
    """Return the header that makes a browser save an answer under a name (RFC 6266, RFC 5987)."""
    plain = unicodedata.normalize("NFKD", file).encode("ascii", "ignore").decode()
    plain = plain.replace('"', "-").replace("\\", "-")
    stem, dot, ending = plain.rpartition(".")
    plain = plain if stem.strip() else f"grid{dot}{ending}"
    value = f"attachment; filename=\"{plain}\"; filename*=UTF-8''{quote(file, safe='')}"
    return {"Content-Disposition": value}
