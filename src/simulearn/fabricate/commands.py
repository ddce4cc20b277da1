"""A line of code, split into commands as firmwares split it."""

import re
from dataclasses import dataclass

from simulearn.errors import InputError
from simulearn.fabricate.firmware import Dialect

PARENTHESES = re.compile(r"\(.*?\)")
NUMBER = re.compile(r"^[Nn]\d+\s*")
NEXT = re.compile(r"(?=\b[GgMm]\d)")
HEAD = re.compile(r"([GMT])\s*0*(\d+(?:\.\d+)?)", re.IGNORECASE)
WORD = re.compile(r"([A-Z])\s*([^\sA-Z]*)", re.IGNORECASE)
NAMED = re.compile(r"(\w+)=(\S*)")
GLUED = re.compile(r"[\d.][Ee][-+]?\d")
TEXT = {"M23", "M28", "M30", "M32", "M98", "M117", "M118", "M550", "M862.3"}  # of any content
LARGEST = 1e6


@dataclass(frozen=True)
class Command:
    """A command.

    Attributes:
        name: in capitals and without leading zeros: G1, M109, G92.1, T0, PRINT_START.
        words: its parameters as text, by letter or, of Klipper's own commands, by name.
        text: as it was written.
    """

    name: str
    words: dict[str, str]
    text: str

    @property
    def is_code(self) -> bool:
        """Whether it is a letter and a number, and no word."""
        return HEAD.fullmatch(self.name) is not None

    def number(self, letter: str, where: str) -> float | None:
        """Return a parameter, or None if it is not given or has no number.

        Raises:
            InputError: it is not a number that a printer can use.
        """
        text = self.words.get(letter)
        if not text:
            return None
        try:
            value = float(text)
        except ValueError as error:
            raise InputError(f"{where}: {letter}{text} is not a number") from error
        if not abs(value) <= LARGEST:  # NaN compares false
            raise InputError(f"{where}: {letter}{text} is not a number a printer can use")
        return value


def commands(line: str, dialect: Dialect) -> list[Command]:
    """Return the commands of a line."""
    code = line.split(";", 1)[0]
    if dialect.parentheses:
        code = PARENTHESES.sub("", code)
    code = NUMBER.sub("", code.strip())
    if not code or _command(code).name in TEXT:
        return [_command(code)] if code else []
    return [_command(part.strip()) for part in NEXT.split(code) if part.strip()]


def _command(code: str) -> Command:
    match = HEAD.match(code)
    if not match:
        words = {name.upper(): value for name, value in NAMED.findall(code)}
        return Command(code.split()[0].upper(), words, code)
    name = f"{match[1]}{match[2]}".upper()
    rest = code[match.end() :]
    words = {} if name in TEXT else {key.upper(): text for key, text in WORD.findall(rest)}
    return Command(name, words, code)
