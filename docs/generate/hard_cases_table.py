"""Prints how this package, coal and Drake answer the hard cases.

python docs/generate/hard_cases_table.py --write
"""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from hard_cases import HARD_CASES
from page_parts import make_parser, to_markdown
from page_stamp import show_parts
from pair_peers import ours, with_coal, with_drake
from pair_score import Library, Score, score_case

PAGE = Path(__file__).parents[2] / "docs" / "verification" / "numerics.md"
PART = "hard cases"
LIBRARIES = {
    "tracked": Library(ours, is_tracked=True, is_warm=True),
    "global": Library(partial(ours, depth="global"), is_warm=True),
    "coal": Library(with_coal),
    "Drake": Library(with_drake),
}
OURS, PEERS = ("tracked", "global"), ("coal", "Drake")
HEAD = ["case", "poses", "local", "worst error"]
HEAD += [f"{name}: {what}" for name in PEERS for what in ("wrong", "gross")]


def row(name: str, scores: dict[str, Score]) -> list[str]:
    """Returns a case's cells of the table."""
    coal = scores["coal"]
    line = [name, str(coal.asked + coal.refused), str(scores["tracked"].not_global)]
    line.append(f"{max(scores[depth].worst for depth in OURS):.0e}")
    for peer in PEERS:
        found = scores[peer]
        line += (
            [str(found.wrong), str(found.gross)] if found.asked else ["not asked", ""]
        )
    return line


def describe_ours(wrong: dict[str, int], poses: int) -> str:
    """Returns how many answers of this package are wrong, by depth."""
    tracked, least = (wrong[depth] for depth in OURS)
    return (
        f"Of the answers of this package in {poses:,} poses {tracked} are wrong with"
        f" `depth: tracked` and {least} with `depth: global`.\n"
    )


def main() -> None:
    """Prints the table, and writes it into the page if asked to."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--only", nargs="*", help="parts of the names of cases")
    args = parser.parse_args()
    rows = [HEAD]
    wrong, poses = dict.fromkeys(OURS, 0), 0
    for name, passages in HARD_CASES.items():
        if args.only and not any(part in name for part in args.only):
            continue
        print(name, file=sys.stderr)
        scores = score_case(passages(), LIBRARIES)
        rows.append(row(name, scores))
        poses += scores["coal"].asked + scores["coal"].refused
        for depth in OURS:
            wrong[depth] += scores[depth].wrong
            for complaint in scores[depth].complaints:
                print(f"  {depth}: {complaint}", file=sys.stderr)
    text = f"{describe_ours(wrong, poses)}\n{to_markdown(rows, numbers=len(HEAD) - 1)}"
    show_parts(PAGE, {PART: text}, __file__, args.write)


if __name__ == "__main__":
    main()
