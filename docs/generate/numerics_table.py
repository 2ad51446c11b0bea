"""Sums up, for docs/verification/numerics.md, the figures of the pages on hard cases.

python docs/generate/numerics_table.py --write

Nothing is measured here: each figure is that of the page in its row, written by that
page's own command.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from page_parts import make_parser, replace_part, to_markdown
from press_page import read_gains, read_rows

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "verification" / "numerics.md"
HEAD = ["what could be wrong", "tried on", "here", "for comparison", "page"]
# Gains of the presses on verification/contact-laws.md, and their names here.
PRESSED = {
    "default": "default gains",
    "sinking": "a contact that sinks in 1.2 mm",
    "shipped": "the gains of the shipped scenes",
    "soft": "a contact that sinks in 3.2 mm",
}
# Its truth is a smooth sphere; its error is that of the triangles.
_TESSELLATED = "tessellated sphere at 40 orientations"


def read_table(page: str, first_heading: str) -> list[dict[str, str]]:
    """Returns the rows of the table of a page that begins with a heading.

    Args:
        page: Name of the file.
        first_heading: Heading of the table's first column.

    Raises:
        ValueError: There is no such table.
    """
    text = (DOCS / page).read_text(encoding="utf-8")
    for table in re.findall(r"(?m)(?:^\|.*\|$\n?)+", text):
        head, _, *rows = [
            [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            for line in table.splitlines()
        ]
        if head[0] == first_heading:
            return [dict(zip(head, row, strict=False)) for row in rows]
    raise ValueError(f"{page}: no table begins with {first_heading!r}")


def _total(rows: list[dict[str, str]], column: str) -> int:
    """Sums a column, without the cells that were not measured."""
    return sum(int(row[column]) for row in rows if row.get(column, "").isdigit())


def _percent(rows: list[dict[str, str]], columns: list[str]) -> str:
    largest = max(float(row[c].removesuffix("%")) for row in rows for c in columns)
    return f"{largest:g} %"


def summary_rows() -> Iterator[list[str]]:
    """Yields the table's rows, the first one its head."""
    yield HEAD
    hard = "verification/numerics.md"
    cases = read_table(hard, "case")
    tracked = _find(hard, r"(\d+) are wrong with `depth: tracked`")
    least = _find(hard, r"and (\d+) with `depth: global`")
    yield [
        "distance, depth, normal or witness of a pair in a degenerate pose",
        f"{len(cases)} cases, {_total(cases, 'poses'):,} poses, held against integers",
        f"{tracked} wrong tracked, {least} wrong global",
        f"coal {_total(cases, 'coal: wrong'):,},"
        f" {_total(cases, 'coal: gross')} of them grossly; Drake"
        f" {_total(cases, 'Drake: wrong'):,},"
        f" {_total(cases, 'Drake: gross'):,} grossly",
        "[hard cases](#the-hard-cases-of-the-pair-query)",
    ]
    presses, gains_rows = read_rows(), read_gains()
    for gains, words in PRESSED.items():
        rows = [row for row in presses if row["gains"] == gains]
        [of_all] = [row for row in gains_rows if row["gains"] == gains]
        yield [
            f"the tool falls through, {words}",
            f"{_total(rows, 'met'):,} presses and jabs on"
            f" {len({row['solid'] for row in rows})} solids",
            f"{_total(rows, 'lost')} lost contact, {_total(rows, 'through')} got"
            f" through, {_total(rows, 'hooked')} hooked behind an edge",
            f"{of_all['inward']} pushed inward, {of_all['NaN']} NaN",
            "[presses](contact-laws.md#softer-springs)",
        ]
    sliding = "verification/continuity.md"
    slides = _find(sliding, r"(\d+) slides:")
    lost = _find(sliding, r"(\d+) ticks without a contact")
    ripple = _find(sliding, r"force ripples by ([0-9.]+) %")
    clusters = read_table(sliding, "face")
    octree = [name for name in clusters[0] if name.startswith("δ")]
    yield [
        "seams between pieces are felt",
        f"{slides} slides over one plane in many pieces",
        f"ripple of the force {float(ripple):g} %, {lost} ticks without contact",
        f"octree up to {_percent(clusters, octree)}",
        "[seams](continuity.md#seams)",
    ]
    wrenches = read_table("verification/wrenches.md", "scenario")
    exact = [row for row in wrenches if row["scenario"] != _TESSELLATED]
    yield [
        "force or torque is not that of the formula",
        f"{len(exact)} scenarios with closed forms",
        f"error {_largest(exact, 'error, shared')} at most",
        f"octree {_largest(exact, 'error, octree')}, where a face is cut",
        "[wrenches](wrenches.md)",
    ]
    yield from _make_jump_rows()
    yield _make_derivative_row()


def _largest(rows: list[dict[str, str]], *columns: str) -> str:
    values = [float(row[x]) for row in rows for x in columns if row[x] != "–"]
    return f"{max(values):.0e}"


def _make_jump_rows() -> Iterator[list[str]]:
    """Yields a row for the default gains, and one for softer ones."""
    rows = read_table("verification/continuity.md", "scene")
    steps = int(
        _find("verification/continuity.md", r"take ([\d,]+) random").replace(",", "")
    )
    for gains, is_default in (("default gains", True), ("softer gains", False)):
        chosen = [r for r in rows if r["scene"].endswith(", default") == is_default]
        shared, octree = (
            [row for row in chosen if row["method"] == method]
            for method in ("shared", "octree")
        )
        force = max(float(row["force"]) for row in shared)
        yield [
            f"the force jumps in a micrometer, {gains}",
            f"{steps:,} steps in each of {len(shared)} scenes",
            f"{_share_of_jumps(shared, steps)} of the steps change force or torque by"
            " over 10 times what their spring explains, the force by"
            f" {float(f'{force:.3g}'):,g} times at most",
            f"octree {_share_of_jumps(octree, steps)}",
            "[continuity](continuity.md)",
        ]


def _share_of_jumps(rows: list[dict[str, str]], steps: int) -> str:
    share = sum(int(row["over 10"]) for row in rows) / (steps * len(rows))
    return f"{1e3 * share:.2g} ‰"


def _make_derivative_row() -> list[str]:
    states = _find("gradients.md", r"Of ([\d,]+) states")
    rows = read_table("gradients.md", "pair")
    loops = read_table("gradients.md", "scene")
    return [
        "a derivative is wrong",
        f"{states} states of contact, and whole loops of {len(loops)} scenes",
        f"relative error {_largest(rows, 'F', 'K', 'B', 'as a diagram')} at most,"
        f" {_largest(loops, 'update', 'rates')} of whole loops",
        "central differences",
        "[derivatives](../gradients.md#verification)",
    ]


def _find(page: str, pattern: str) -> str:
    """Returns the group of a pattern in a page."""
    text = (DOCS / page).read_text(encoding="utf-8")
    found = re.search(pattern.replace(" ", r"\s+"), text)
    if found is None:
        raise ValueError(f"{page}: nothing like {pattern}")
    return found[1]


def main() -> None:
    """Prints the table, and with --write puts it into the page."""
    write = make_parser(__doc__, PAGE).parse_args().write
    table = to_markdown(summary_rows())
    print(table)
    if write:
        page = PAGE.read_text(encoding="utf-8")
        PAGE.write_text(replace_part(page, table, "summary"), encoding="utf-8")


if __name__ == "__main__":
    main()
