"""Writes tables, and HTML pages in one file."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drake_haptics.common.errors import HapticsError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Table:
    """Text in rows and columns.

    Attributes:
        title: Subject of the table, one line.
        note: Explanation of the table, in sentences.
        header: Heading of each column.
        rows: Rows as long as the header, which begin with a name.
    """

    title: str
    note: str
    header: tuple[str, ...]
    rows: list[tuple[str, ...]]

    @staticmethod
    def of(
        title: str,
        note: str,
        columns: Mapping[str, Callable[[Any], str]],
        items: Iterable[Any],
    ) -> Table:
        """Returns a table with a row for each item, its columns by their headings."""
        rows = [tuple(text(item) for text in columns.values()) for item in items]
        return Table(title, note, tuple(columns), rows)

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
    """Checks that a page and its picture are different files.

    Raises:
        HapticsError: The path has the picture's suffix.
    """
    if path.suffix == ".png":
        raise HapticsError(
            f"the page must not be called {path.name}: its picture will be. Give a"
            " name that ends with .html"
        )


def draw_png(figure: Figure, dpi: int = 110) -> bytes:
    """Returns a figure as PNG with a resolution in dots per inch."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=dpi)
    return stream.getvalue()


def write_picture(figure: Figure, page: Path) -> bytes:
    """Writes the picture of a page as a PNG file next to it, and returns it.

    Raises:
        HapticsError: The page has the picture's suffix.
        OSError: The file cannot be written.
    """
    check_page_path(page)
    png = draw_png(figure)
    page.with_suffix(".png").write_bytes(png)
    return png


def write_page(path: Path, template: str, **data: object) -> None:
    """Writes a page as one HTML file.

    Args:
        path: Path of the file.
        template: Path of its Jinja template in the package, which extends
            `report/page.html`.
        **data: Values of the names in the template. Text is escaped.

    Raises:
        OSError: The file cannot be written.
    """
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    environment = Environment(
        loader=FunctionLoader(_read_template),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    environment.filters["base64"] = lambda png: base64.b64encode(png).decode()
    page = environment.get_template(template).render(**data)
    path.write_text(page, encoding="utf-8")


def _read_template(name: str) -> str:
    return files("drake_haptics").joinpath(name).read_text(encoding="utf-8")
