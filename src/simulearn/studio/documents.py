"""Documents that the page saves as people draw: one file each, never half of one, never lost.

Whoever knows the name of a document may read and change it; names cannot be guessed and are never
listed. A document has a revision. A change says which one it was made from: if another window has
saved since, it is refused and gets the newer one, so that nobody's work is overwritten unseen.
"""

import json
import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from simulearn.errors import InputError
from simulearn.files import parse_json, read_text, replacing
from simulearn.studio.documentfile import check_document
from simulearn.studio.problems import Problem
from simulearn.studio.settings import Settings

SCHEMA = "simulearn.saved/1"
NAME = re.compile(r"[A-Za-z0-9_-]{22}")
MOST_BYTES = 2**30  # of all documents
LOCK = ".lock"


@dataclass(frozen=True)
class Saved:
    """A document and how often it was saved."""

    revision: int
    document: dict[str, Any]


class Documents:
    """The documents of a server.

    Args:
        settings: the folder, and how many and how large they may be; without a folder they are kept
            in memory.
    """

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._shelf = _Memory() if settings.data is None else _Folder(settings.data)
        self._lock = threading.Lock()

    def read(self, name: str) -> Saved:
        """Return a document.

        Raises:
            Problem: there is none of that name, or its file is damaged.
        """
        saved = self._saved(_checked(name))
        if saved is None:
            raise Problem(404, "document-unknown", "no document of this name is saved here", "id")
        return saved

    def write(self, name: str, revision: int, document: Any) -> int:
        """Save a document.

        Args:
            name: of the document, made by the page.
            revision: that the document was made from; 0 for a new one.
            document: as `documentfile` describes it.

        Returns:
            The new revision; saving once more what is saved already changes nothing.

        Raises:
            InputError: it is not a document.
            Problem: another window has saved since, or it cannot be kept: too large, too many, or
                the folder cannot be written.
        """
        _checked(name)
        check_document(document)
        most = self._settings.document_bytes
        if len(json.dumps(document)) > most:
            text = (
                f"the document is too large to be saved here; it has at most {most / 2**20:g} MiB"
            )
            raise Problem(413, "document-too-large", text, "document")
        with self._lock, self._shelf.locked():
            before = self._saved(name)
            if before is None:
                self._check_room()
            elif before.document == document:
                return before.revision  # as after an answer that was lost on its way
            elif before.revision != revision:
                raise Problem(
                    409,
                    "changed-elsewhere",
                    "the document was changed in another window since it was opened here",
                    "revision",
                    more={"revision": before.revision, "document": before.document},
                )
            # A document whose file is gone goes on where its page is.
            now = Saved(revision + 1, document)
            self._shelf.write(name, _text(now))
            return now.revision

    def _saved(self, name: str) -> Saved | None:
        text = self._shelf.read(name)
        if text is None:
            return None
        try:
            data = parse_json(text)
            if data["schema"] != SCHEMA or not isinstance(data["revision"], int):
                raise InputError("is of another kind")
            check_document(data["document"])
        except (InputError, KeyError, TypeError) as error:
            where = self._shelf.place(name)
            text = f"the saved document {where} is damaged; move it away to save anew ({error})"
            raise Problem(500, "document-damaged", text, "id") from error
        return Saved(data["revision"], data["document"])

    def _check_room(self) -> None:
        """Raise a problem where no further document is taken."""
        count, size = self._shelf.totals()
        if count >= self._settings.documents or size >= MOST_BYTES:
            what = f"{count} documents of {size / 2**20:.0f} MiB in all are saved in"
            text = f"{what} {self._shelf.place('')}; no more are taken until some are moved away"
            raise Problem(507, "documents-full", text)


class _Memory:
    """Texts that last as long as the server."""

    def __init__(self) -> None:
        self._texts: dict[str, str] = {}

    def read(self, name: str) -> str | None:
        return self._texts.get(name)

    def write(self, name: str, text: str) -> None:
        self._texts[name] = text

    def totals(self) -> tuple[int, int]:
        return len(self._texts), sum(map(len, self._texts.values()))

    def place(self, name: str) -> str:
        return "memory"

    @contextmanager
    def locked(self) -> Iterator[None]:
        yield


class _Folder:
    """Texts as files of a folder, which is made when the first one is written."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def read(self, name: str) -> str | None:
        path = self.place(name)
        try:
            return read_text(path)
        except InputError as error:
            if isinstance(error.__cause__, FileNotFoundError | NotADirectoryError):
                return None
            raise Problem(500, "document-damaged", str(error), "id") from error

    def write(self, name: str, text: str) -> None:
        try:
            with replacing(self.place(name)) as temporary:
                temporary.write_text(text, "utf-8")
        except InputError as error:
            raise _unwritable(str(error)) from error

    def totals(self) -> tuple[int, int]:
        sizes = [path.stat().st_size for path in self._folder.glob("*.json")]
        return len(sizes), sum(sizes)

    def place(self, name: str) -> Path:
        return self._folder / f"{name}.json" if name else self._folder

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Keep other servers on the same folder from writing meanwhile."""
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            lock = (self._folder / LOCK).open("a")
        except OSError as error:
            raise _unwritable(f"{self._folder}: cannot be written ({error.strerror})") from error
        with lock:
            _wait_for(lock.fileno())  # closing the file gives it free
            yield


def _wait_for(handle: int) -> None:
    """Lock an open file against other processes, where the system can."""
    try:
        import fcntl
    except ImportError:  # Windows
        return
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
    except OSError:  # some network file systems have no locks
        return


def _unwritable(reason: str) -> Problem:
    text = f"the document cannot be saved on the server: {reason}"
    return Problem(507, "not-writable", text)


def _checked(name: str) -> str:
    """Return the name of a document, which becomes that of a file."""
    if NAME.fullmatch(name) is None:
        text = "a document is named by 22 characters of A-Z, a-z, 0-9, - and _"
        raise Problem(404, "document-unknown", text, "id")
    return name


def _text(saved: Saved) -> str:
    data = {"schema": SCHEMA, "revision": saved.revision, "document": saved.document}
    return json.dumps(data, allow_nan=False) + "\n"
