"""Writes the evaluation as one page that any browser shows."""

from __future__ import annotations

import base64
import html
import io
from collections import Counter
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from string import Template

from drake_haptics.evaluation.paper.evaluation import PaperEvaluation
from drake_haptics.evaluation.paper.report import (
    Block,
    Picture,
    Section,
    describe_machine_line,
    make_sections,
)
from drake_haptics.evaluation.paper.statement import MEANING, Statement
from drake_haptics.report.page import Table

_DPI = 110


def write_paper_page(evaluation: PaperEvaluation, path: Path) -> list[Path]:
    """Writes the page as one HTML file, and each picture beside it as PNG.

    Args:
        evaluation: What `evaluate_paper` returned.
        path: Of the HTML file; pictures are called after it.

    Returns:
        The pictures' paths.

    Raises:
        OSError: A file cannot be written.
    """
    sections = make_sections(evaluation)
    pictures: dict[str, bytes] = {}
    for section in sections:
        for picture in section.pictures:
            pictures[picture.key] = render(picture)
    template = files("drake_haptics.evaluation.paper").joinpath("page.html")
    page = Template(template.read_text(encoding="utf-8")).substitute(
        summary=html.escape(summarize(sections)),
        machine=html.escape(describe_machine_line(evaluation)),
        sections="".join(_make_section(section, pictures) for section in sections),
    )
    paths = []
    for key, png in pictures.items():
        paths.append(path.with_name(f"{path.stem}-{key}.png"))
        paths[-1].write_bytes(png)
    path.write_text(page, encoding="utf-8")
    return paths


def render(picture: Picture, dpi: int = _DPI) -> bytes:
    """Returns a picture as PNG.

    Args:
        picture: Of a section.
        dpi: Its dots per inch.
    """
    stream = io.BytesIO()
    picture.draw().savefig(stream, format="png", dpi=dpi)
    return stream.getvalue()


def summarize(sections: Sequence[Section]) -> str:
    """Says how many statements there are of each verdict."""
    counts = Counter(
        statement.verdict for section in sections for statement in section.statements
    )
    parts = [
        f"{counts[verdict]} {meaning}"
        for verdict, meaning in MEANING.items()
        if counts[verdict]
    ]
    return f"Of {counts.total()} statements {', '.join(parts)}."


def _make_section(section: Section, pictures: dict[str, bytes]) -> str:
    blocks = "".join(_make_block(block, pictures) for block in section.blocks)
    return (
        f'<section id="{section.part}"><h2>{html.escape(section.title)}</h2>{blocks}'
        f"{''.join(map(_make_table, section.tables))}</section>\n"
    )


def _make_block(block: Block, pictures: dict[str, bytes]) -> str:
    title = f"<h3>{html.escape(block.title)}</h3>" if block.title else ""
    images = "".join(
        f'<div class="wide"><img alt="{html.escape(picture.alt)}"'
        f' src="data:image/png;base64,'
        f'{base64.b64encode(pictures[picture.key]).decode()}"></div>'
        for picture in block.pictures
    )
    statements = "".join(map(_make_statement, block.statements))
    return f"{title}<ul>{statements}</ul>{images}"


def _make_statement(statement: Statement) -> str:
    verdict = statement.verdict
    return (
        f'<li><span class="mark {verdict.replace(" ", "-")}">{verdict}</span>'
        f"{html.escape(statement.text)}</li>"
    )


def _make_table(table: Table) -> str:
    def make_row(tag: str, cells: Sequence[str]) -> str:
        inner = "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells)
        return f"<tr>{inner}</tr>"

    body = "".join(make_row("td", row) for row in table.rows)
    return (
        f'<h3>{html.escape(table.title)}</h3><p class="note">{html.escape(table.note)}'
        f'</p><div class="wide"><table>{make_row("th", table.header)}{body}</table>'
        "</div>"
    )
