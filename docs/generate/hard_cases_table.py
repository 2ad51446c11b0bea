"""Prints how this package, coal and Drake answer the hard cases.

python docs/generate/hard_cases_table.py --write
"""

from __future__ import annotations

import argparse
import sys
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from hard_cases import HARD_CASES
from page_stamp import write_page
from pair_peers import ours, with_coal, with_drake
from pair_score import Library, Score, score_case

DOCS = Path(__file__).parents[2] / "docs" / "verification" / "hard-cases.md"
START, END = "<!-- table -->\n", "<!-- end of table -->\n"
LIBRARIES = {
    "tracked": Library(ours, is_tracked=True, is_warm=True),
    "global": Library(partial(ours, depth="global"), is_warm=True),
    "coal": Library(with_coal),
    "Drake": Library(with_drake),
}
COLUMNS = " | ".join(f"{name}: wrong | gross | worst error" for name in LIBRARIES)
RULES = "--:|" * (2 + 3 * len(LIBRARIES))
HEADER = f"| case | poses | local | {COLUMNS} |\n|---|{RULES}\n"


def cells(score: Score) -> list[str]:
    """Returns wrong, gross and worst error of a library."""
    if not score.asked:
        return ["not asked", "", ""]
    return [str(score.wrong), str(score.gross), f"{score.worst:.0e}"]


def row(name: str, scores: dict[str, Score]) -> str:
    """Returns a case's line of the table."""
    coal = scores["coal"]
    local = str(scores["tracked"].not_global)
    line = [name, str(coal.asked + coal.refused), local]
    for library in scores:
        line += cells(scores[library])
    return f"| {' | '.join(line)} |\n"


def cases_in(text: str) -> list[str]:
    """Returns the names of the cases in the document's table."""
    table = text.split(START)[1].split(END)[0]
    return [line.split("|")[1].strip() for line in table.splitlines()[2:]]


def main() -> None:
    """Prints the table, and writes it into the document if asked to."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"into {DOCS.name}")
    parser.add_argument("--only", nargs="*", help="parts of the names of cases")
    args = parser.parse_args()
    print(HEADER, end="")
    table = HEADER
    for name, passages in HARD_CASES.items():
        if args.only and not any(part in name for part in args.only):
            continue
        scores = score_case(passages(), LIBRARIES)
        table += row(name, scores)
        print(row(name, scores), end="", flush=True)
        for depth in ("tracked", "global"):
            for complaint in scores[depth].complaints:
                print(f"  {depth}: {complaint}", file=sys.stderr)
    if args.write:
        before, rest = DOCS.read_text().split(START)
        write_page(DOCS, before + START + table + END + rest.split(END)[1], __file__)


if __name__ == "__main__":
    main()
