"""Tables and file names of the pages that commands write."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from drake_haptics.common.errors import HapticsError


@dataclass(frozen=True)
class Table:
    """Text in rows and columns.

    Attributes:
        title: what it is about, a line.
        note: how to read it, some sentences.
        header: of each column.
        rows: as long as the header each; the first cell says what the row is.
    """

    title: str
    note: str
    header: tuple[str, ...]
    rows: list[tuple[str, ...]]

    def to_markdown(self) -> str:
        """Returns the table as a section of a Markdown page."""
        lines = [f"### {self.title}", "", self.note, ""]
        lines.append(_row(self.header))
        lines.append(_row(("---",) + ("--:",) * (len(self.header) - 1)))
        lines += [_row(row) for row in self.rows]
        return "\n".join(lines) + "\n"


def _row(cells: tuple[str, ...]) -> str:
    return f"| {' | '.join(cells)} |"


def check_page_path(path: Path) -> None:
    """Checks that page and picture are two files.

    Raises:
        HapticsError: The path has the picture's suffix.
    """
    if path.suffix == ".png":
        raise HapticsError(
            f"the page must not be called {path.name}: its picture will be. Give a"
            " name that ends with .html"
        )
