"""The elements of an SVG file: bytes to text, text to a tree, without trust in the file.

Nothing outside of the file is opened, entities inside of it are bounded, and so are depth and
count, so that no file can hang or fill the machine.
"""

import codecs
import re
import zlib
from dataclasses import dataclass, field
from xml.parsers import expat

from simulearn.errors import InputError

LARGEST = 32 * 2**20  # bytes of text
DEEPEST = 200
MOST_ELEMENTS = 250_000
LONGEST_TEXT = 2**20  # characters kept, at least
LONGEST_ENTITIES = 4 * 2**20  # characters that all entities of a file may add

SVG = "http://www.w3.org/2000/svg"
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
SODIPODI = "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"
SERIF = "http://www.serif.com/"
XLINK = "http://www.w3.org/1999/xlink"

_WITH_TEXT = {"style", "title"}
_CODECS = re.compile(r"utf|iso|latin|windows|cp|mac|shift|sjis|euc|gb|big5|koi8|us|ascii", re.I)


@dataclass(slots=True, eq=False)
class Element:
    """One element.

    Attributes:
        tag: its name without prefix.
        attributes: by name; those of a namespace as "namespace name".
        line: of the file, from 1.
        parent: the element around it; None for the outermost.
        children: the elements in it that belong to SVG.
        text: its text, kept for style sheets and titles only.
    """

    tag: str
    attributes: dict[str, str]
    line: int
    parent: "Element | None" = None
    children: "list[Element]" = field(default_factory=list)
    text: str = ""

    @property
    def name(self) -> str:
        """What the file calls it: its id, or what and where it is."""
        return self.attributes.get("id") or f"{self.tag} in line {self.line}"


@dataclass(eq=False)
class Document:
    """An SVG file as a tree.

    Attributes:
        root: the outermost `svg`.
        elements: all elements, in the order of the file.
        comments: the first comments, where programs write their names.
        namespaces: all that are declared.
        messages: remarks in plain sentences.
    """

    root: Element
    elements: list[Element]
    comments: list[str]
    namespaces: set[str]
    messages: list[str]


def read_tree(data: bytes) -> Document:
    """Return the elements of an SVG file, plain or compressed (SVGZ).

    Raises:
        InputError: the file is too large, no XML, or its outermost element is no `svg`.
    """
    messages: list[str] = []
    return _Builder(_text(_unpacked(data), messages), messages).document()


def _unpacked(data: bytes) -> bytes:
    if data[:2] == b"\x1f\x8b":
        try:
            data = zlib.decompressobj(31).decompress(data, LARGEST + 1)
        except zlib.error:
            raise InputError("its compression (SVGZ) is damaged", "svg-broken") from None
    if len(data) > LARGEST:
        raise InputError(f"is larger than {LARGEST // 2**20} MiB", "too-large")
    return data


def _text(data: bytes, messages: list[str]) -> str:
    """Return the text of a file: by its byte order mark, else by what it declares, else UTF-8."""
    declared = re.match(rb"""\s*<\?xml[^>]{0,200}?encoding\s*=\s*["']([\w.:-]{1,40})["']""", data)
    name = declared.group(1).decode("ascii", "replace") if declared else "utf-8"
    if data.startswith(codecs.BOM_UTF8):
        name = "utf-8-sig"
    elif data.startswith((codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE)):
        name = "utf-32"
    elif data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        name = "utf-16"
    elif data[:2] in (b"<\0", b"\0<"):
        name = "utf-16-le" if data[0] else "utf-16-be"
    elif re.match(r"utf-?(16|32)|ucs", name, re.I):
        name = "utf-8"  # the declaration itself could be read byte by byte
    try:
        if not _CODECS.match(name):
            raise LookupError(name)
        return data.decode(name)
    except LookupError:
        messages.append(f"Its encoding {name} is not known; it was read as UTF-8.")
    except UnicodeDecodeError:
        messages.append(f"Its letters are not {name} as it says; they were read as Latin-1.")
        return data.decode("latin-1")
    return data.decode("utf-8", "replace")


class _Builder:
    """Builds the tree from the events of the XML parser."""

    def __init__(self, text: str, messages: list[str]) -> None:
        self.text = text.lstrip("\ufeff \t\r\n")
        self.skipped_lines = text[: len(text) - len(self.text)].count("\n")
        self.messages = messages
        self.elements: list[Element] = []
        self.comments: list[str] = []
        self.namespaces: set[str] = set()
        self.space = SVG
        self.open: list[Element] = []
        self.foreign = 0  # how deep in elements that are not SVG
        self.added = 0  # characters by entities

    def document(self) -> Document:
        if not self.text:
            raise InputError("is empty", "svg-broken")
        parser = self.parser = expat.ParserCreate(namespace_separator=" ")
        parser.buffer_size = 2**20
        parser.buffer_text = True
        parser.StartElementHandler = self.start
        parser.EndElementHandler = self.end
        parser.CharacterDataHandler = self.characters
        parser.CommentHandler = self.comment
        parser.StartNamespaceDeclHandler = self.namespace
        parser.ProcessingInstructionHandler = self.instruction
        parser.EntityDeclHandler = self.entity
        parser.SkippedEntityHandler = self.skipped
        parser.ExternalEntityRefHandler = self.external
        try:
            parser.Parse(self.text, True)
        except expat.ExpatError as error:
            line, column = error.lineno + self.skipped_lines, error.offset + 1
            raise InputError(
                f"is no well-formed XML: {_words(error.code)} in line {line}, column {column}; "
                "save the drawing anew, or mend that place",
                "svg-broken",
                f"line {line}",
            ) from None
        return Document(
            self.elements[0], self.elements, self.comments, self.namespaces, self.messages
        )

    def start(self, name: str, attributes: dict[str, str]) -> None:
        space, _, tag = name.rpartition(" ")
        if not self.elements:
            if tag != "svg":
                raise InputError(f"its outermost element is <{tag}>, not <svg>", "not-svg")
            self.space = space
            if space != SVG:
                self.messages.append(
                    f'It does not say xmlns="{SVG}"; it was read as SVG all the same, '
                    "but browsers do not show it."
                )
        if self.foreign or space != self.space:
            self.foreign += 1
            return
        line = self.parser.CurrentLineNumber + self.skipped_lines
        if len(self.open) >= DEEPEST:
            raise InputError(
                f"its elements are nested more than {DEEPEST} deep (line {line})", "too-large"
            )
        if len(self.elements) >= MOST_ELEMENTS:
            raise InputError(f"has more than {MOST_ELEMENTS:,} elements", "too-large")
        element = Element(tag, attributes, line, self.open[-1] if self.open else None)
        if element.parent:
            element.parent.children.append(element)
        self.elements.append(element)
        self.open.append(element)

    def end(self, name: str) -> None:
        if self.foreign:
            self.foreign -= 1
        else:
            self.open.pop()

    def characters(self, text: str) -> None:
        if not self.open or self.foreign or self.open[-1].tag not in _WITH_TEXT:
            return
        if len(self.open[-1].text) <= LONGEST_TEXT:
            self.open[-1].text += text

    def comment(self, text: str) -> None:
        if len(self.comments) < 20:
            self.comments.append(text[:500].strip())

    def namespace(self, prefix: str | None, uri: str | None) -> None:
        if uri:
            self.namespaces.add(uri)

    def instruction(self, target: str, text: str) -> None:
        if target == "xml-stylesheet":
            self.messages.append("It names a style sheet in another file, which is not read.")

    def entity(
        self,
        name: str,
        parameter: int,
        value: str | None,
        base: str | None,
        system: str | None,
        public: str | None,
        notation: str | None,
    ) -> None:
        if parameter or value is None:
            return  # neither is ever opened
        if "&" in value:
            raise InputError(f"its entity {name} is made of other entities", "svg-broken")
        self.added += self.text.count(f"&{name};") * len(value)
        if self.added > LONGEST_ENTITIES:
            raise InputError(f"its entity {name} makes it too large", "too-large")

    def skipped(self, name: str, parameter: int) -> None:
        if not parameter:
            self.tell(f"Its entity {name} is declared outside of the file, which is not read.")

    def external(
        self, context: str, base: str | None, system: str | None, public: str | None
    ) -> int:
        self.tell("It refers to text outside of the file, which is not read.")
        return 1  # done with, without being opened

    def tell(self, message: str) -> None:
        if message not in self.messages:
            self.messages.append(message)


def _words(code: int) -> str:
    """Return what is wrong with the XML."""
    words = {
        "no element found": "it ends before its elements do",
        "unclosed token": "it ends within an element",
        "mismatched tag": "an element is closed that is not the one open",
        "unbound prefix": "a prefix is used without its xmlns declaration",
        "undefined entity": "an entity is used that is declared nowhere",
        "not well-formed (invalid token)": "a character that cannot stand there",
        "duplicate attribute": "an attribute is given twice",
    }
    text = expat.ErrorString(code) or "an error"
    return words.get(text, text)
