"""Gather the pages of the documentation site into one folder, from which the site is built.

python docs/site/stage.py FOLDER

The pages of docs/ are read on a code host, too, so they link to files outside docs/ and show
pictures for light and dark by HTML. Here such links are led to copies of these files, pictures
are made to follow the switch of the page, and what the program itself knows (its commands, its
functions, what was measured) is written as pages. Nothing of the result is kept in the repository.
"""

import argparse
import re
import shutil
import sys
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
HERE = Path(__file__).resolve().parent
ICON = ROOT / "src" / "simulearn" / "studio" / "page" / "icon.svg"
PAGES = {"README.md": "index.md", "CHANGELOG.md": "changelog.md"}  # pages outside docs/
MEASURED = "Each page is written by a command of the repository; `make bench` runs them all."
COPIES = "files"  # folder of the site for files outside docs/

FENCE = re.compile(r"^( *)(```+|~~~+).*?^\1\2 *$", re.M | re.S)
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)")
PICTURE = re.compile(
    r'<picture><source media="\(prefers-color-scheme: dark\)" srcset="([^"]+)">'
    r'<img src="([^"]+)" alt="([^"]*)"></picture>'
)


def pages() -> dict[str, Path]:
    """Return the source of each page by its place in the site."""
    found = {
        path.relative_to(DOCS).as_posix(): path
        for path in sorted(DOCS.rglob("*.md"))
        if HERE not in path.parents
    }
    for source, page in PAGES.items():
        found.setdefault(page, ROOT / source)
    return found


def outside_code(text: str) -> list[tuple[bool, str]]:
    """Return the pieces of a page in their order, each with whether it is a block of code."""
    pieces, at = [], 0
    for block in FENCE.finditer(text):
        pieces += [(False, text[at : block.start()]), (True, block.group())]
        at = block.end()
    return [*pieces, (False, text[at:])]


def links(text: str) -> list[str]:
    """Return the targets of all links and pictures of a page that are not web addresses."""
    plain = "".join(piece for code, piece in outside_code(text) if not code)
    found = [target for _, _, target in LINK.findall(plain)]
    found += re.findall(r'<(?:img|source)[^>]* (?:src|srcset)="([^"]+)"', plain)
    return [one for one in found if not re.match(r"[a-z]+:", one)]


def staged(text: str, page: str, source: Path, copies: dict[str, Path]) -> str:
    """Return a page as the site takes it.

    Args:
        text: of the page.
        page: its place in the site.
        source: its file, from which its links lead.
        copies: files to copy by their place in the site; those that are needed are added.
    """
    up = "../" * page.count("/")

    def led(match: re.Match[str]) -> str:
        mark, words, target = match.groups()
        path, hash_, anchor = target.partition("#")
        if re.match(r"[a-z]+:", target) or not path:
            return match.group()
        file = (source.parent / path).resolve()
        place = file.relative_to(ROOT).as_posix() if file.is_relative_to(ROOT) else ""
        if place in PAGES:
            return f"{mark}[{words}]({up}{PAGES[place]}{hash_}{anchor})"
        if file.is_relative_to(DOCS):
            inside = file.relative_to(DOCS).as_posix() + ("/index.md" if file.is_dir() else "")
            return f"{mark}[{words}]({relative(page, inside)}{hash_}{anchor})"
        if file.is_file() and place:
            copies[f"{COPIES}/{place}"] = file
            return f"{mark}[{words}]({up}{COPIES}/{place})"
        return f"`{place}`" if words == place or not place else f"{words} (`{place}`)"

    def shades(match: re.Match[str]) -> str:
        dark, light, alt = match.groups()
        return f"![{alt}]({light}#only-light)\n![{alt}]({dark}#only-dark)"

    def piece(code: bool, part: str) -> str:
        return part if code else LINK.sub(led, PICTURE.sub(shades, part))

    return "".join(piece(code, part) for code, part in outside_code(text))


def relative(page: str, target: str) -> str:
    """Return the relative path from a page to a file, both by their place in the site."""
    here, there = PurePosixPath(page).parent.parts, PurePosixPath(target).parts
    same = 0
    while same < min(len(here), len(there) - 1) and here[same] == there[same]:
        same += 1
    return "/".join([".."] * (len(here) - same) + list(there[same:]))


def stage(folder: Path, generated: dict[str, str]) -> None:
    """Write all pages, pictures and copies into a folder, which is made anew.

    Args:
        folder: where.
        generated: text of pages that have no file, by their place in the site.
    """
    shutil.rmtree(folder, ignore_errors=True)
    copies = {
        path.relative_to(DOCS).as_posix(): path
        for path in sorted(DOCS.rglob("*"))
        if path.is_file() and path.suffix != ".md" and HERE not in path.parents
    }
    copies |= {"site.css": HERE / "site.css", "icon.svg": ICON}
    texts = dict(generated)
    for page, source in pages().items():
        texts[page] = staged(source.read_text(encoding="utf-8"), page, source, copies)
    for place, text in texts.items():
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        (folder / place).write_text(text, encoding="utf-8")
    for place, source in copies.items():
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, folder / place)


def measured() -> str:
    """Return the list of the pages of measured figures, each with the command that makes it."""
    rows = ["| measured | by |\n| --- | --- |\n"]
    for path in sorted((DOCS / "measured").glob("*.md")):
        text = path.read_text(encoding="utf-8")
        title = text.partition("\n")[0].removeprefix("# ")
        command = re.search(r"Made by (`[^`]+`)", text)
        rows.append(f"| [{title}]({path.name}) | {command.group(1) if command else ''} |\n")
    return f"# Measured figures\n\n{MEASURED}\n\n{''.join(rows)}"


def generated() -> dict[str, str]:
    """Return the pages that have no file, by their place in the site."""
    if str(HERE) not in sys.path:
        sys.path.insert(0, str(HERE))
    import commands
    import python

    return {commands.GENERATED: commands.text(), "measured/index.md": measured(), **python.pages()}


def main() -> None:
    """Write the folder that is named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    stage(folder, generated())


if __name__ == "__main__":
    main()
