"""Writes the figures of a run into docs/verification/benchmarks.md.

drake-haptics bench --json figures.json
python docs/generate/write_docs.py figures.json

Of `bench loop --json` only the tables of whole ticks are written.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

from page_parts import replace_part
from page_stamp import amend_page, write_page

from drake_haptics.evaluation.benchmark.benchmark import (
    BenchFigures,
    machine_line,
    make_tables,
    missing_lines,
)

PAGE = Path(__file__).resolve().parents[2] / "docs" / "verification" / "benchmarks.md"
_END = "<!-- end of figures -->\n"


def with_figures(page: str, figures: BenchFigures) -> str:
    """Returns the page with the tables of these figures."""
    sections = [f"{machine_line(figures)}\n"]
    if figures.missing:
        sections.append(
            "\n".join(f"- {line}" for line in missing_lines(figures)) + "\n"
        )
    sections += [table.to_markdown() for table in make_tables(figures)]
    return replace_part(page, "\n".join(sections))


def with_tables(page: str, figures: BenchFigures) -> str:
    """Returns the page with the tables of these figures in place of its own.

    Tables that the page does not have yet come after all others.
    """
    for table in make_tables(figures):
        section = re.compile(
            rf"### {re.escape(table.title)}\n.*?(?=\n### |\n{re.escape(_END)})", re.S
        )
        page, replaced = section.subn(lambda _, t=table: t.to_markdown(), page)
        if not replaced:
            page = page.replace(f"\n{_END}", f"\n{table.to_markdown()}\n{_END}")
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
