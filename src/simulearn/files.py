"""Reading and writing files so that a reader never meets half of one, and what the machine has.

A file is written beside its final place under a temporary name and then renamed, which the
operating system does in one step: a reader of the final name gets the old file or the new one.
"""

import codecs
import errno
import io
import json
import os
import re
import secrets
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import platformdirs

from simulearn.errors import InputError

# A file of more bytes is not read unless its reader allows it.
MOST_BYTES = 2**30
MOST_TRIES = 100
MARKS = {  # the byte order mark with which a text begins, and its encoding; the longer ones first
    codecs.BOM_UTF32_LE: "utf-32",
    codecs.BOM_UTF32_BE: "utf-32",
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}
# The numbers of errors of a disk or folder that takes no more.
NO_ROOM = {errno.ENOSPC, errno.EFBIG, errno.EROFS, errno.EIO, getattr(errno, "EDQUOT", errno.EIO)}


def cache_folder() -> Path | None:
    """Return the folder for what can be computed again, by the custom of the platform.

    None where there is no such folder, as for a user without a home.
    """
    return _own_folder(platformdirs.user_cache_dir)


def data_folder() -> Path | None:
    """Return the folder for what this user makes; None where there is none, as without a home."""
    return _own_folder(platformdirs.user_data_dir)


def _own_folder(of_platform: Callable[..., str]) -> Path | None:
    try:
        path = Path(of_platform("simulearn", appauthor=False))
    except (RuntimeError, OSError, KeyError):  # no home can be found
        return None
    return path if path.is_absolute() else None


def cores() -> int:
    """Return how many processors this process may use."""
    if sys.version_info >= (3, 13):
        return os.process_cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def replacing(path: Path | str) -> Iterator[Path]:
    """Yield a temporary path beside `path`; on leaving without an error it becomes `path`.

    The contents are on the disk before the file has its final name. Where `path` is a symbolic
    link, the file that it names is replaced and the link stays.

    Raises:
        InputError: the folder does not exist or takes no file, or the disk is full.
    """
    final = _final(Path(path))
    try:
        temporary = _created(final)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error
    try:
        yield temporary
        handle = os.open(temporary, os.O_RDWR)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
        temporary.replace(final)
    except OSError as error:
        if (reason := _of_writing(error, temporary)) is None:
            raise
        raise InputError(f"{path}: cannot be written ({reason})") from error
    finally:
        temporary.unlink(missing_ok=True)


def _final(path: Path) -> Path:
    """Return the path of the file itself, or raise InputError where no file can be."""
    try:
        final = Path(os.path.realpath(path))
        folder, there, file = final.is_dir(), final.exists(), final.is_file()
        parent, beside = final.parent.is_dir(), final.parent.exists()
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error
    except ValueError as error:
        raise InputError(f"{str(path)!r}: is not the name of a file ({error})") from error
    if folder:
        raise InputError(f"{path}: is a folder; name a file")
    if not parent:
        why = "is not a folder" if beside else "does not exist"
        raise InputError(f"{path}: the folder {path.parent} {why}")
    if there and not file:
        raise InputError(f"{path}: is a device or a pipe; name a file")
    return final


def _created(final: Path) -> Path:
    """Create an empty file beside another one, with the access that new files have here."""
    for _ in range(MOST_TRIES):
        # The ending stays, since writers choose their format by it.
        temporary = final.with_name(f".{secrets.token_hex(8)}{final.suffix}")
        try:
            os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_RDWR, 0o666))
        except FileExistsError:
            continue
        return temporary
    raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST))


def _of_writing(error: OSError, temporary: Path) -> str | None:
    """Return why a file could not be written, or None if an error has another cause."""
    number = error.errno
    if number is None and (match := re.search(r"errno = (\d+)", str(error))):
        number = int(match[1])  # HDF5 writes it into its message
    names = {str(name) for name in (error.filename, error.filename2) if name is not None}
    if number in NO_ROOM or str(temporary) in names:
        return error.strerror or os.strerror(number or errno.EIO)
    return None


def read_text(path: Path | str, most: int = MOST_BYTES) -> str:
    """Return the text of a file, or raise InputError with the reason.

    Args:
        path: of the file.
        most: the number of bytes that it may have.

    Raises:
        InputError: the file is missing, a folder, unreadable, too large, or not UTF-8 text.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            data = file.read(most + 1)
        if len(data) > most:
            raise InputError(f"{path}: is too large; at most {most / 2**20:g} MiB can be read")
        return decoded(data)
    except FileNotFoundError as error:
        raise InputError(f"{path}: there is no such file") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text") from error
    except InputError:
        raise
    except ValueError as error:
        raise InputError(f"{str(path)!r}: is not the name of a file ({error})") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error


def is_there(path: Path | str) -> bool:
    """Return whether there is such a file or folder; no where nothing can have such a name."""
    try:
        return Path(path).exists()
    except (OSError, ValueError):
        return False


def path_from(folder: Path, path: Path) -> str:
    """Return a path as seen from a folder, with slashes; on another drive the whole path."""
    try:
        return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    except ValueError:
        return path.resolve().as_posix()


def marked_encoding(data: bytes) -> str | None:
    """Return the encoding that a byte order mark names; None where bytes begin with none."""
    return next((name for mark, name in MARKS.items() if data.startswith(mark)), None)


def decoded(data: bytes) -> str:
    """Return bytes as text: UTF-8, or what a byte order mark says; lines end in a newline only.

    Raises:
        UnicodeDecodeError: they are no such text.
    """
    encoding = marked_encoding(data) or "utf-8"
    return io.TextIOWrapper(io.BytesIO(data), encoding=encoding).read()


def parse_json(text: str) -> Any:
    """Return what a JSON text holds; more strictly than Python, which takes NaN and double keys.

    Raises:
        InputError: the text is not JSON; `where` is the place.
    """
    try:
        text = text.removeprefix("\ufeff")  # a byte order mark that came with the text
        return json.loads(text, parse_constant=_no_constant, object_pairs_hook=_no_twins)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise InputError(f"is not valid JSON at {place}: {error.msg}", "json", place) from error
    except RecursionError as error:
        raise InputError("is not valid; its lists are nested too deeply", "json") from error
    except InputError:
        raise
    except ValueError as error:  # Python refuses to convert thousands of digits
        raise InputError("holds a number with too many digits", "json") from error


def _no_constant(name: str) -> None:
    raise InputError(f"{name} is not a number that JSON may hold", "json", name)


def _no_twins(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    data = dict(pairs)
    if len(data) < len(pairs):
        keys = [key for key, _ in pairs]
        twin = json.dumps(next(key for key in keys if keys.count(key) > 1))
        twin = twin if len(twin) <= 40 else twin[:37] + "..."
        raise InputError(f"the key {twin} occurs twice", "json", twin)
    return data
