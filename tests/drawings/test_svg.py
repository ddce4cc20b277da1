"""SVG as a file: encodings, entities, what is broken or hostile, speed."""

import gzip
import math
import random

import numpy as np
import pytest
from svgs import LINE, PAGE, ends, left, read, svg

from simulearn.errors import InputError


@pytest.mark.parametrize(
    "encode",
    [
        lambda text: text.encode(),
        lambda text: b"\xef\xbb\xbf" + text.encode(),
        lambda text: text.encode("utf-16"),
        lambda text: text.encode("utf-16-le"),
        lambda text: text.encode("utf-16-be"),
        lambda text: text.encode("utf-32"),
        lambda text: b'<?xml version="1.0" encoding="ISO-8859-1"?>' + text.encode("latin-1"),
        lambda text: b'<?xml version="1.0" encoding="windows-1252"?>' + text.encode("cp1252"),
        lambda text: ('<?xml version="1.0" encoding="UTF-16"?>' + text).encode("utf-16"),
        lambda text: ('<?xml version="1.0" encoding="UTF-16"?>' + text).encode(),
        lambda text: ('\n\n <?xml version="1.0"?>' + text).encode(),
        lambda text: text.replace("\n", "\r\n").encode(),
        lambda text: gzip.compress(text.encode()),
    ],
)
def test_encodings(encode):
    drawing = read(encode(svg(f'<g id="Träger">\n{LINE}</g>')))
    assert drawing.lines[0].layer == "Träger"
    assert not drawing.messages


def test_letters_in_another_encoding_than_declared_are_reported():
    drawing = read(svg(f'<g id="Träger">{LINE}</g>').encode("latin-1"))
    assert drawing.lines[0].layer == "Träger"
    assert "Latin-1" in drawing.messages[0]
    drawing = read(b'<?xml version="1.0" encoding="klingon"?>' + svg(LINE).encode())
    assert "klingon" in drawing.messages[0]


def test_the_entities_of_illustrator_are_read():
    text = (
        '<?xml version="1.0"?><!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" '
        '"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd" [\n'
        '<!ENTITY ns_svg "http://www.w3.org/2000/svg">\n<!ENTITY blue "#0072b2">]>'
        f'<svg xmlns="&ns_svg;" {PAGE}><line stroke="&blue;" x2="65"/></svg>'
    )
    assert read(text).lines[0].colour == "#0072b2"


def test_any_prefix_and_none():
    prefixed = (
        f'<s:svg xmlns:s="http://www.w3.org/2000/svg" {PAGE}><s:line stroke="red" x2="65"/></s:svg>'
    )
    assert ends(read(prefixed)) == [(0, 100, 65, 100)]
    bare = read(f'<svg {PAGE}><line stroke="red" x2="65"/></svg>')
    assert ends(bare) == [(0, 100, 65, 100)]
    assert "xmlns" in bare.messages[0]


def test_elements_of_other_programs_are_passed_over():
    body = f'<x:thing xmlns:x="urn:x"><line x2="3"/></x:thing>{LINE}<newthing/>'
    drawing = read(svg(body))
    assert len(drawing.lines) == 1
    assert left(drawing) == {("newthing", "", "is no element of SVG known here"): 1}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (svg(LINE)[:-9], "line 1, column"),
        (svg("\n\n<line x2='3'>"), "line 3, column"),
        (svg("\n<g></h>"), "line 2, column"),
        (svg("&what;"), "declared nowhere"),
        (f"\n\n<svg {PAGE}><q:g/></svg>", "line 3"),
        ("<svg x=1/>", "line 1, column 8"),
        ("", "empty"),
        ("hello", "line 1"),
        ("<html><svg/></html>", "<html>"),
        ("\x00\x01\x02", "line 1"),
    ],
)
def test_a_broken_file_is_refused_with_the_place(text, words):
    with pytest.raises(InputError) as caught:
        read(text)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def laughs():
    entities = [f'<!ENTITY e{k + 1} "{10 * f"&e{k};"}">' for k in range(12)]
    return f'<!DOCTYPE svg [<!ENTITY e0 "ha">{"".join(entities)}]>' + svg("<text>&e12;</text>")


def uses(levels, copies):
    groups = [
        f'<g id="u{k + 1}">' + f'<use href="#u{k}"/>' * copies + "</g>" for k in range(levels)
    ]
    return svg('<line id="u0" x2="9"/>' + "".join(groups))


@pytest.mark.parametrize(
    "text",
    [
        laughs(),
        '<!DOCTYPE svg [<!ENTITY a "' + 90_000 * "a" + '">]>' + svg(9000 * "&a;"),
        uses(9, 10),
        uses(900, 1),
        svg(5000 * "<g>" + 5000 * "</g>"),
        svg('<path d="M0 0' + 110_000 * "h1v1" + '"/>'),
        svg("<style>" + 9000 * "line{stroke:red}" + "</style>" + 900 * "<line/>"),
        gzip.compress(b"<svg>" + 33 * 2**20 * b" "),
        svg("").encode() + 32 * 2**20 * b" ",
        gzip.compress(svg(LINE).encode())[:60] + 16 * b"x",
    ],
    ids=["laughs", "entity", "uses", "chain", "deep", "path", "rules", "bomb", "large", "torn"],
)
def test_what_would_take_for_ever_is_refused(text):
    with pytest.raises(InputError):
        read(text)


def test_nothing_outside_of_the_file_is_opened(tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text("h65")
    text = f'<!DOCTYPE svg [<!ENTITY x SYSTEM "{secret.as_uri()}">]>' + svg(
        f"<title>&x;</title>{LINE}"
    )
    drawing = read(text)
    assert len(drawing.lines) == 1
    assert "outside of the file" in drawing.messages[0]


def test_all_of_3000_lines_are_read():
    body = "".join(
        f'<path style="fill:none;stroke:#{k % 4096:06x};stroke-width:1" transform="rotate({k})" '
        f'd="m {k},{k % 77} {k + 9.5},{k % 7}" id="path{k}"/>'
        for k in range(3000)
    )
    assert len(read(svg(body)).lines) == 3000


MIXED = svg(
    "<style>.a{stroke:red;transform:rotate(3deg)} #b &gt; g{display:none}</style>"
    '<defs><symbol id="s" viewBox="0 0 9 9"><path d="M0 0C1 2 3 4 5 6zm3 3a5 5 0 0 1 9 9"/>'
    "</symbol>"
    '</defs><g transform="rotate(30) translate(3,4) matrix(1 0 0 1 2 3)" id="top 0.5">'
    '<use href="#s" x="3" width="50%" height="3mm"/><rect class="a" width="9" height="8" rx="2"/>'
    '<polygon points="0,0 5,5 3-2"/><text>words</text></g>'
    '<svg viewBox="0 0 10 10" width="5em" preserveAspectRatio="none"><circle r="10%"/></svg>',
    before='<?xml version="1.0" encoding="UTF-8"?><!DOCTYPE svg [<!ENTITY e "x">]>',
).encode()


@pytest.mark.parametrize("seed", range(100))
def test_damaged_files_are_read_or_refused(seed):
    chance = random.Random(seed)
    data = bytearray(MIXED)
    kind = seed % 5
    if kind == 0:
        data = data[: chance.randrange(len(data))]
    elif kind == 1:
        for _ in range(chance.randrange(1, 6)):
            data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    elif kind == 2:
        data = bytearray(chance.randbytes(chance.randrange(1, 3000)))
    elif kind == 3:
        words = bytes(data).split(b" ")
        for _ in range(5):
            a, b = chance.randrange(len(words)), chance.randrange(len(words))
            words[a], words[b] = words[b], words[a]
        data = bytearray(b" ".join(words))
    else:  # still well-formed: numbers and words in attributes are exchanged
        odd = [
            b"1e999",
            b"-",
            b"NaN",
            b"%",
            b"(",
            b"url(",
            b"1e-400",
            b"0",
            b"#s",
            b"e",
            b"99999999",
        ]
        for _ in range(6):
            at = chance.randrange(len(data))
            if bytes(data[at : at + 1]).isdigit():
                data[at : at + 1] = chance.choice(odd)
    try:
        drawing = read(bytes(data))
    except InputError:
        pass
    else:
        for line in drawing.lines:
            assert np.isfinite(line.points).all()
            assert line.points.shape[1] == 3
            assert len(line.points) >= 2
        for curve in drawing.curves:
            points = curve.flatten(0.1)
            assert points.shape[1] == 3
            assert math.isfinite(points.sum())
