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

DOCS = Path(__file__).parents[2] / "docs" / "verification" / "numerics.md"
START, END = "<!-- hard cases -->\n", "<!-- end of hard cases -->\n"
LIBRARIES = {
    "tracked": Library(ours, is_tracked=True, is_warm=True),
    "global": Library(partial(ours, depth="global"), is_warm=True),
    "coal": Library(with_coal),
    "Drake": Library(with_drake),
}
OURS, PEERS = ("tracked", "global"), ("coal", "Drake")
HEAD = ["case", "poses", "local", "worst error"]
HEAD += [f"{name}: {what}" for name in PEERS for what in ("wrong", "gross")]
RULES = f"|---|{'--:|' * (len(HEAD) - 1)}\n"


def _line(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |\n"


def row(name: str, scores: dict[str, Score]) -> str:
    """Returns a case's line of the table."""
    coal = scores["coal"]
    line = [name, str(coal.asked + coal.refused), str(scores["tracked"].not_global)]
    line.append(f"{max(scores[depth].worst for depth in OURS):.0e}")
    for peer in PEERS:
        found = scores[peer]
        line += (
            [str(found.wrong), str(found.gross)] if found.asked else ["not asked", ""]
        )
    return _line(line)


def describe_ours(wrong: dict[str, int], poses: int) -> str:
    """Returns how many answers of this package are wrong, by depth."""
    tracked, least = (wrong[depth] for depth in OURS)
    return (
        f"Of the answers of this package in {poses:,} poses {tracked} are wrong with"
        f" `depth: tracked` and {least} with `depth: global`.\n\n"
    )


def cases_in(text: str) -> list[str]:
    """Returns the names of the cases in the document's table."""
    table = text.split(START)[1].split(END)[0]
    rows = [line for line in table.splitlines() if line.startswith("|")]
    return [line.split("|")[1].strip() for line in rows[2:]]


def main() -> None:
    """Prints the table, and writes it into the document if asked to."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"into {DOCS.name}")
    parser.add_argument("--only", nargs="*", help="parts of the names of cases")
    args = parser.parse_args()
    table = _line(HEAD) + RULES
    print(table, end="")
    wrong, poses = dict.fromkeys(OURS, 0), 0
    for name, passages in HARD_CASES.items():
        if args.only and not any(part in name for part in args.only):
            continue
        scores = score_case(passages(), LIBRARIES)
        table += row(name, scores)
        print(row(name, scores), end="", flush=True)
        poses += scores["coal"].asked + scores["coal"].refused
        for depth in OURS:
            wrong[depth] += scores[depth].wrong
            for complaint in scores[depth].complaints:
                print(f"  {depth}: {complaint}", file=sys.stderr)
    table = describe_ours(wrong, poses) + table
    if args.write:
        before, rest = DOCS.read_text().split(START)
        write_page(DOCS, before + START + table + END + rest.split(END)[1], __file__)


if __name__ == "__main__":
    main()
