"""A line of G-code taken apart into commands, each with its words."""

import re
from dataclasses import dataclass

from simulearn.errors import InputError

NUMBER = re.compile(r"^[Nn]\d+\s*")
CHECKSUM = re.compile(r"\*\d+\s*$")
COMMAND = re.compile(r"(?=\b[GgMm]\d)")
HEAD = re.compile(r"([GMT])\s*0*(\d+(?:\.\d+)?)", re.IGNORECASE)
WORD = re.compile(r"([A-Z])\s*([^\sA-Z]*)", re.IGNORECASE)
GLUED = re.compile(r"[\d.][Ee][-+]?\d")
SHOWN = ("M117", "M118", "RESPOND")  # their text is shown, not done
MOST = 1e6


@dataclass(frozen=True)
class Command:
    """One command.

    Attributes:
        head: G1, M104, T0, or the name of a macro in capitals.
        numbered: whether it is a G, M or T with a number, and not a macro.
        words: letters with what follows them, in capitals, in order.
        text: all that follows the head.
    """

    head: str
    numbered: bool
    words: tuple[tuple[str, str], ...]
    text: str

    def __contains__(self, letter: object) -> bool:
        return any(key == letter for key, _ in self.words)

    def value(self, letter: str, where: str) -> float | None:
        """Return the number after a letter, None where the letter is not there or bare.

        Raises:
            InputError: what stands there is not a number that a printer can use.
        """
        for key, text in self.words:
            if key == letter and text:
                return _number(letter, text, where)
        return None

    @property
    def named(self) -> dict[str, str]:
        """NAME=value words of a macro, the names in capitals."""
        pairs = (part.split("=", 1) for part in self.text.split() if "=" in part)
        return {name.upper(): value for name, value in pairs}


def commands(line: str, where: str) -> list[Command]:
    """Return the commands of a line without its comment.

    Raises:
        InputError: a number and an E stand together, which printers read differently.
    """
    code = CHECKSUM.sub("", re.sub(r"\(.*?\)", "", line)).strip()
    code = NUMBER.sub("", code)
    if code.upper().startswith(SHOWN):
        return []
    return [_command(part.strip(), where) for part in COMMAND.split(code) if part.strip()]


def _command(code: str, where: str) -> Command:
    match = HEAD.match(code)
    if match is None:
        head, _, rest = code.partition(" ")
        return Command(head.upper(), False, (), rest.strip())
    rest = code[match.end() :].strip()
    head = f"{match[1]}{match[2]}".upper()
    if head in ("G0", "G1") and GLUED.search(rest):
        # 1E5 is X1 and E5 to some printers, 100000 to others.
        raise InputError(f"{where}: printers differ in how they read {rest}; put a space before E")
    words = tuple((key.upper(), text) for key, text in WORD.findall(rest))
    return Command(head, True, words, rest)


def _number(letter: str, text: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError as error:
        raise InputError(f"{where}: {letter}{text} is not a number") from error
    if not abs(value) <= MOST:  # NaN compares false
        raise InputError(f"{where}: {letter}{text} is not a number a printer can use")
    return value
