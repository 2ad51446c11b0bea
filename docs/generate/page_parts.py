"""Parts of pages that programs write, each between two marks that name it."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Sequence
from pathlib import Path


def to_markdown(rows: Iterable[Sequence[str]], numbers: int = 0) -> str:
    """Returns rows as a table of Markdown, the first one its head.

    Args:
        rows: Cells of each row.
        numbers: The last columns, so many, hold numbers and are aligned right.
    """
    lines = ["| " + " | ".join(cells) + " |" for cells in rows]
    texts = lines[0].count("|") - 1 - numbers
    lines.insert(1, "|" + "---|" * texts + "--:|" * numbers)
    return "\n".join(lines) + "\n"


def read_table(text: str) -> list[list[str]]:
    """Returns the cells of a text's table, its head first, without the line below."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    head, _, *body = [[x.strip() for x in line.split("|")[1:-1]] for line in lines]
    return [head, *body]


def find_part(page: str, name: str) -> slice:
    """Returns the place of a part in a page, by the part's name.

    Raises:
        ValueError: A mark is missing.
    """
    begin = re.search(rf"<!-- {name}: written by docs/generate/\w+\.py -->\n", page)
    if begin is None:
        raise ValueError(f"the page has no mark of {name}")
    return slice(begin.end(), page.index(f"<!-- end of {name} -->\n"))


def read_part(page: str, name: str = "figures") -> str:
    """Returns the part of that name.

    Raises:
        ValueError: A mark is missing.
    """
    return page[find_part(page, name)]


def replace_part(page: str, text: str, name: str = "figures") -> str:
    """Returns the page with another text as the part of that name.

    Raises:
        ValueError: A mark is missing.
    """
    span = find_part(page, name)
    return f"{page[: span.start]}\n{text}\n{page[span.stop :]}"


def make_parser(description: str | None, *pages: Path) -> argparse.ArgumentParser:
    """Returns a parser that knows --write.

    Args:
        description: The program's docstring.
        *pages: Pages that it writes.
    """
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    names = " and ".join(page.name for page in pages)
    parser.add_argument("--write", action="store_true", help=f"write {names}")
    return parser
