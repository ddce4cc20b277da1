"""How grids, results and what is said about them show themselves in a notebook.

A result is a page that plays in a frame of its own, without a server; beneath it lies its picture,
for wherever frames are not shown. Everything else is a picture or a table.
"""

import sys
from base64 import b64encode
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from html import escape
from typing import TYPE_CHECKING, Any

from simulearn.errors import InputError, Message
from simulearn.grid import Grid, Validation
from simulearn.interop.plan import plan
from simulearn.interop.png import png
from simulearn.material import name_of
from simulearn.simulate import Failure, Result, remarks, summary
from simulearn.simulate.result import Outcomes

if TYPE_CHECKING:
    from simulearn.inverse import Ranking, SearchResult

MOST_BYTES = 2**22  # of a page in a notebook, which keeps each of them
MOST_ROWS = 40  # of a table
HEIGHT = 600  # px, of a page
TEXT, HTML, PNG, SVG = "text/plain", "text/html", "image/png", "image/svg+xml"
Kinds = dict[str, Callable[[], str | bytes]]  # media type -> what makes it
CELL = "padding:4px 16px 4px 0;text-align:left;vertical-align:top"
SHORT = f"{CELL};white-space:nowrap"


def bundle(item: Any, include: Any = None, exclude: Any = None) -> dict[str, Any]:
    """Return an object by media type: text/plain, text/html, and image/png or image/svg+xml.

    Args:
        item: what is shown.
        include: the media types that are wanted; all if not given.
        exclude: the media types that are not wanted.
    """
    wanted = set(include or (TEXT, HTML, PNG, SVG)) - set(exclude or ())
    if _in_terminal():
        wanted &= {TEXT}
    kinds = next(KINDS[base.__name__] for base in type(item).__mro__ if base.__name__ in KINDS)
    found = {kind: make() for kind, make in kinds(item).items() if kind in wanted}
    return {kind: content for kind, content in found.items() if content}


def _in_terminal() -> bool:
    """Return whether IPython runs in a terminal, which shows text alone."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and shell.display_formatter.active_types == [TEXT]


def _grid(grid: Grid) -> Kinds:
    words = _words(grid)
    return {
        TEXT: lambda: words,
        SVG: lambda: plan(grid),
        HTML: lambda: _figure(_plan(grid), words),
    }


def _result(result: Result) -> Kinds:
    lines = _lines(result)

    @cache
    def picture() -> bytes:
        return _picture(result)

    return {
        TEXT: lambda: "\n".join(lines),
        PNG: picture,
        HTML: lambda: _playing(result, lines, picture()),
    }


def _failure(failure: Failure) -> Kinds:
    said = failure.invalid or (Message(failure.code, failure.where, failure.message),)
    hint = [failure.hint] if failure.hint else []
    return {
        TEXT: lambda: "\n".join(["No result:", *map(_said, said), *hint]),
        HTML: lambda: _figure(_plan(failure.grid), "No result") + _list(said) + _paragraphs(hint),
    }


def _validation(report: Validation) -> Kinds:
    counts = [_count(report.errors, "error"), _count(report.warnings, "warning")]
    title = ("Not valid: " if report.errors else "Valid: ") + ", ".join(counts)
    said = [*report.errors, *report.warnings]
    return {
        TEXT: lambda: "\n".join([title, *map(_said, said[:MOST_ROWS]), *_more(said)]),
        HTML: lambda: _paragraphs([title]) + _list(said),
    }


def _outcomes(outcomes: Outcomes) -> Kinds:
    heads = ("", "joints", "beams", "rises", "error below (9 of 10)", "remarks")
    rows = [_row(number, one) for number, one in enumerate(outcomes[:MOST_ROWS])]
    return _table(_count(outcomes, "outcome"), heads, rows, _more(outcomes))


def _ranking(ranking: "Ranking") -> Kinds:
    heads = ("", "change", "error", "moves by")
    rows = [
        [str(k + 1), one.change.words, f"{one.error_mm:.2f} mm", f"{one.moved_mm:.2f} mm"]
        for k, one in enumerate(ranking.best)
    ]
    title = f"{len(ranking.suggestions)} changes; the best {len(rows)} that differ:"
    return _table(title, heads, rows)


def _search(found: "SearchResult") -> Kinds:
    shape = None if found.check is None else found.check.shape
    best = _grid(found.grid) if shape is None else _result(shape)
    lines = _lines_of_search(found)
    both: Kinds = {
        TEXT: lambda: "\n".join([*lines, str(best[TEXT]())]),
        HTML: lambda: _paragraphs(lines) + str(best[HTML]()),
    }
    return {**best, **both}


KINDS: dict[str, Callable[[Any], Kinds]] = {  # by name, so that none is loaded for another
    "Failure": _failure,
    "Grid": _grid,
    "Outcomes": _outcomes,
    "Ranking": _ranking,
    "Result": _result,
    "SearchResult": _search,
    "Validation": _validation,
}


def _words(grid: Grid) -> str:
    return (
        f"Grid of {len(grid.joints)} joints and {len(grid.beams)} beams, "
        f"material {name_of(grid.material)}, fixed at joint {grid.fixed}"
    )


def _lines(result: Result) -> list[str]:
    """Return what a result is and what qualifies it, a line each."""
    numbers = summary(result)
    rise, bound = numbers["rise_mm"], result.bound_mm
    lines = [
        f"{'Rises' if rise >= 0 else 'Falls'} {abs(rise):.1f} mm "
        f"(z {numbers['lowest_mm']:.1f} to {numbers['highest_mm']:.1f} mm); "
        f"{len(result.grid.joints)} joints, {len(result.grid.beams)} beams",
        f"engine {result.engine}, material {result.material.name}"
        + (f", model {result.model.name}" if result.model else ""),
    ]
    if bound is not None:
        lines.append(f"nine of ten such answers are off by less than {bound:.2f} mm")
    return lines + remarks(result) + [message.message for message in result.warnings]


def _lines_of_search(found: "SearchResult") -> list[str]:
    check = found.check
    fea = check.error_fea_mm if check is not None else None
    by_fea = f"{fea:.2f} mm by finite elements, " if fea is not None else ""
    stopped = ", interrupted" if found.interrupted else ""
    lines = [
        f"Best of {found.designs} designs: error {by_fea}{found.error_mm:.2f} mm by the engine "
        f"({found.iterations} iterations, {found.seconds:.1f} s{stopped})"
    ]
    if check is not None and fea is None and check.why:
        lines.append(f"finite elements have no answer: {check.why}")
    for k, one in enumerate(found.answers[1:], 2):
        lines.append(f"answer {k}: {one.error:.2f} mm, {one.words}")
    return lines + [message.message for message in found.warnings]


def _row(number: int, one: Result | Failure) -> list[str]:
    head = [str(number), str(len(one.grid.joints)), str(len(one.grid.beams))]
    if isinstance(one, Failure):
        return [*head, "no result", "", _said(Message(one.code, one.where, one.message))]
    bound = "" if one.bound_mm is None else f"{one.bound_mm:.2f} mm"
    said = [*remarks(one), *(message.message for message in one.warnings)]
    return [*head, f"{summary(one)['rise_mm']:.1f} mm", bound, "; ".join(said)]


def _picture(result: Result) -> bytes:
    from simulearn.show import combined

    return png(combined(result))[0]


def _playing(result: Result, lines: Sequence[str], drawn: bytes) -> str:
    """Return the page of a result in a frame, or its picture and why there is no page."""
    from simulearn.interop.html import page

    try:
        text, reason = page(result), ""
    except InputError as error:
        text, reason = "", f"This is a picture: {error}"
    if len(text) > MOST_BYTES:
        reason = (
            f"This is a picture: the page that moves takes {len(text) / 2**20:.0f} MiB. "
            "simulearn.interop.write_html(result, 'shape.html') writes it."
        )
    words = ". ".join(lines)
    picture = _image(PNG, drawn, words)
    if reason:
        return _figure(picture, words) + _paragraphs([reason])
    # The frame lies over the picture, which is seen where frames are taken out.
    return (
        '<div style="display:grid;grid-template-columns:100%;max-width:1200px">'
        f'<div style="grid-area:1/1">{picture}</div>'
        f'<iframe style="grid-area:1/1;border:0;border-radius:6px" width="100%" height="{HEIGHT}" '
        'loading="lazy" sandbox="allow-scripts allow-downloads" title="Shape that can be played" '
        f'srcdoc="{escape(text)}"></iframe></div>'
    )


def _plan(grid: Grid) -> str:
    drawn = plan(grid).encode("utf-8")
    return _image(SVG, drawn, _words(grid), "width:320px") if len(drawn) < MOST_BYTES else ""


def _image(kind: str, content: bytes, words: str, style: str = "") -> str:
    data = b64encode(content).decode("ascii")
    look = f"max-width:100%;max-height:{HEIGHT}px;{style}"
    return f'<img style="{look}" alt="{escape(words)}" src="data:{kind};base64,{data}">'


def _figure(picture: str, words: str) -> str:
    caption = f"<figcaption>{escape(words)}</figcaption>"
    return f'<figure style="margin:8px 0">{picture}{caption}</figure>'


def _paragraphs(lines: Iterable[str]) -> str:
    return "".join(f"<p>{escape(line)}</p>" for line in lines)


def _list(messages: Sequence[Message]) -> str:
    items = "".join(
        f"<li><strong>{escape(m.where)}</strong>: {escape(m.message)}</li>"
        for m in messages[:MOST_ROWS]
    )
    return (f"<ul>{items}</ul>" if items else "") + _paragraphs(_more(messages))


def _said(message: Message) -> str:
    placed = message.where and message.where not in message.message
    return f"{message.where}: {message.message}" if placed else message.message


def _count(items: Sequence[Any], word: str) -> str:
    return f"{len(items) or 'no'} {word}{'' if len(items) == 1 else 's'}"


def _more(items: Sequence[Any]) -> list[str]:
    return [f"and {len(items) - MOST_ROWS} more"] if len(items) > MOST_ROWS else []


def _cell(text: str) -> str:
    return SHORT if len(text) < 40 else CELL


def _table(
    title: str, heads: Sequence[str], rows: Sequence[Sequence[str]], more: Sequence[str] = ()
) -> Kinds:
    def html() -> str:
        head = "".join(f'<th scope="col" style="{SHORT}">{escape(text)}</th>' for text in heads)
        body = "".join(
            "<tr>" + "".join(f'<td style="{_cell(x)}">{escape(x)}</td>' for x in row) + "</tr>"
            for row in rows
        )
        table = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        return _paragraphs([title]) + table + _paragraphs(more)

    def text() -> str:
        return "\n".join([title, *("  ".join(filter(None, row)) for row in rows), *more])

    return {TEXT: text, HTML: html}
