"""Presses, jabs and slides tools at many points of many solids; tabulates verdicts.

python docs/generate/press_table.py --points 40 --gains sinking
python docs/generate/press_table.py --points 1000 --jobs 3 --write
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from page_parts import make_parser
from press_cells import (
    REAL,
    SHIPPED,
    TITLES,
    TOOLS,
    Cell,
    complaints,
    find_mesh,
    row,
    run_points,
)
from press_page import MOTIONS as PAGE_MOTIONS
from press_page import PAGE, write_presses
from press_rig import GAINS, MOTIONS
from press_tools import make_tools
from press_verdict import Verdict

# Points that a worker takes at a time.
CHUNK = 25


def main() -> None:
    """Runs the presses that the arguments name."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--points", type=int, default=40)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--solids", nargs="*", default=[*SHIPPED, *REAL])
    parser.add_argument(
        "--tools",
        nargs="*",
        default=TOOLS,
        choices=make_tools(),
        help="point i is met by tool i modulo their number",
    )
    parser.add_argument(
        "--motions", nargs="*", default=[*PAGE_MOTIONS], choices=MOTIONS
    )
    parser.add_argument("--gains", nargs="*", default=[*GAINS], choices=GAINS)
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--failures", type=Path, help="file that gets each failure")
    args = parser.parse_args()
    if args.write and {*args.motions} != {*PAGE_MOTIONS}:
        parser.error(f"--write needs --motions {' '.join(PAGE_MOTIONS)}")
    for name in args.solids:
        if find_mesh(name) is None:
            print(f"{name} is not beside the repository: skipped", file=sys.stderr)
    cells = [
        Cell(solid, tuple(args.tools), motion, gains, args.seed)
        for gains in args.gains
        for motion in args.motions
        for solid in args.solids
        if find_mesh(solid) is not None
    ]
    rows = []
    print(*TITLES, sep="  ", flush=True)
    with ProcessPoolExecutor(args.jobs) as pool:
        for cell, verdicts in _run(pool, cells, args.points):
            rows.append(row(cell, verdicts.values()))
            print(*rows[-1], sep="  ", flush=True)
            if args.failures:
                _note(args.failures, cell, verdicts)
    if args.write:
        write_presses(rows, args.points)


def _run(
    pool: ProcessPoolExecutor, cells: list[Cell], points: int
) -> Iterator[tuple[Cell, dict[int, Verdict]]]:
    """Yields each cell when all its points are done."""
    chunks = [range(i, min(i + CHUNK, points)) for i in range(0, points, CHUNK)]
    jobs = {pool.submit(_chunk, c, chunk): c for c in cells for chunk in chunks}
    found: dict[Cell, dict[int, Verdict]] = {cell: {} for cell in cells}
    for done, job in enumerate(as_completed(jobs), 1):
        cell = jobs[job]
        found[cell].update(job.result())
        if sys.stderr.isatty():
            print(f"\r{done}/{len(jobs)}", end="\r", file=sys.stderr)
        if len(found[cell]) == points:
            yield cell, found.pop(cell)


def _chunk(cell: Cell, points: range) -> dict[int, Verdict]:
    return dict(run_points(cell, points))


def _note(path: Path, cell: Cell, verdicts: dict[int, Verdict]) -> None:
    with path.open("a") as file:
        for i, verdict in sorted(verdicts.items()):
            why = complaints(verdict, GAINS[cell.gains])
            if why:
                tool = cell.tools[i % len(cell.tools)]
                print(
                    f"{cell.solid} {tool} {cell.motion} {cell.gains} "
                    f"seed {cell.seed} point {i}: {why}",
                    file=file,
                )


if __name__ == "__main__":
    main()
