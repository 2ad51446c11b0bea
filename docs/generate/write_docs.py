"""Writes the figures of a run into docs/benchmarks.md.

drake-haptics bench --json figures.json
python docs/generate/write_docs.py figures.json

Of `bench loop --json` only the tables of whole ticks are written.
"""

from __future__ import annotations

import json
import re
import sys
from dataclasses import replace
from pathlib import Path

from page_parts import replace_part
from page_stamp import amend_page, write_page

from drake_haptics.evaluation.benchmark.benchmark import (
    BenchFigures,
    machine_line,
    make_tables,
    missing_lines,
)

PAGE = Path(__file__).resolve().parents[2] / "docs" / "benchmarks.md"
_END = "<!-- end of figures -->\n"
# Tables whose note has all that the page tells, and scenes that only the command shows.
NOTED = ("One pair query from Python",)
LEFT_OUT = ("torus_peg",)


def show_tables(figures: BenchFigures) -> dict[str, str]:
    """Returns the tables as sections of the page, by title.

    Rows with equal figures are one row, and a note stands once.
    """
    sections: dict[str, str] = {}
    notes: set[str] = set()
    for table in make_tables(figures):
        if any(scene in table.title for scene in LEFT_OUT):
            continue
        if table.title in NOTED:
            sections[table.title] = f"### {table.title}\n\n{table.note}\n"
            continue
        joined: dict[tuple[str, ...], list[str]] = {}
        for name, *cells in table.rows:
            joined.setdefault(tuple(cells), []).append(name)
        rows = [("; ".join(names), *cells) for cells, names in joined.items()]
        note = "As above." if table.note in notes else table.note
        notes.add(table.note)
        sections[table.title] = replace(table, rows=rows, note=note).to_markdown()
    return sections


def with_figures(page: str, figures: BenchFigures) -> str:
    """Returns the page with the tables of these figures."""
    sections = [f"{machine_line(figures)}\n"]
    if figures.missing:
        sections.append(
            "\n".join(f"- {line}" for line in missing_lines(figures)) + "\n"
        )
    sections += show_tables(figures).values()
    return replace_part(page, "\n".join(sections))


def with_tables(page: str, figures: BenchFigures) -> str:
    """Returns the page with the tables of these figures in place of its own.

    Tables that the page does not have yet come after all others.
    """
    for title, text in show_tables(figures).items():
        section = re.compile(
            rf"### {re.escape(title)}\n.*?(?=\n### |\n{re.escape(_END)})", re.S
        )
        page, replaced = section.subn(lambda _, t=text: t, page)
        if not replaced:
            page = page.replace(f"\n{_END}", f"\n{text}\n{_END}")
    return page


def main() -> None:
    """Reads the figures from the file named on the command line."""
    data = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    page = PAGE.read_text(encoding="utf-8")
    figures = BenchFigures.from_dict(data)
    if figures.pairs or figures.scenes:
        write_page(PAGE, with_figures(page, figures), __file__)
    else:
        amend_page(
            PAGE, with_tables(page, figures), __file__, "whole ticks of the loop"
        )


if __name__ == "__main__":
    main()
