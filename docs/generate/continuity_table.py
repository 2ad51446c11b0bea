"""Tabulates how much the wrench changes in steps of a micrometer, and why it jumps.

python docs/generate/continuity_table.py --scenes box --steps 20000
python docs/generate/continuity_table.py --jobs 3 --write
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from continuity_rig import CAUSES, JUMP, Steps, measure
from continuity_scenes import SCENES, make_scene
from continuity_walk import EPISODE_STEPS
from page_parts import make_parser, to_markdown
from page_stamp import write_parts
from press_rig import GAINS, LARGEST_FORCE_N
from wrench_chain import METHODS

PAGE = Path(__file__).parents[2] / "docs" / "verification" / "continuity.md"
TITLES = ("scene", "method", "force", "99.9 %", "torque", "99.9 %", f"over {JUMP:g}")
TITLES += (*CAUSES, "of the largest", "chain alone")

# Columns of the page; causes are summed up below its table.
SHOWN = ("scene", "method", "force", "99.9 %", "torque", "99.9 %", f"over {JUMP:g}")
SHOWN += ("of the largest", "chain alone")
_KEPT = [*range(len(SHOWN) - 2), len(TITLES) - 2, len(TITLES) - 1]
_CAUSES = range(len(SHOWN) - 2, len(TITLES) - 2)


def describe_walk(steps: int) -> str:
    """Returns how the steps are made, as a sentence."""
    return (
        f"Here tools take {steps:,} random steps of about a micrometer in contact with"
        f" solids, around {-(-steps // EPISODE_STEPS)} random poses each, nowhere"
        f" deeper than what carries {LARGEST_FORCE_N:g} N.\n"
    )


def make_steps(rows: Sequence[Sequence[str]]) -> str:
    """Returns the page's table, and what causes the steps above the limit.

    Args:
        rows: Rows of `row`.
    """
    table = to_markdown([SHOWN, *([cells[i] for i in _KEPT] for cells in rows)])
    causes = [["cause", *METHODS]]
    for i, cause in zip(_CAUSES, CAUSES, strict=True):
        by_method = (sum(int(x[i]) for x in rows if x[1] == m) for m in METHODS)
        causes.append([cause, *(f"{count:,}" for count in by_method)])
    title = f"Causes of all steps over {JUMP:g}, by method:"
    return f"{table}\n{title}\n\n{to_markdown(causes)}"


def describe_gains() -> str:
    """Returns the gains that the names of scenes end with."""
    return "".join(
        f"- {name}: tolerance {1e3 * g.tolerance_m:g} mm, stiffness"
        f" {g.stiffness_N_per_m:g} N/m, δ {1e3 * g.delta_m:g} mm\n"
        for name, g in GAINS.items()
        if name in ("default", "sinking", "soft")
    )


def row(key: str, method: str, found: Steps) -> list[str]:
    """Returns the texts of a line of the table."""
    ratio, exceeds, causes = found.ratio, found.exceeds, found.causes
    largest, usual = ratio.max(axis=0), np.quantile(ratio, 0.999, axis=0)
    at_largest = int(ratio.max(axis=1).argmax())
    return [
        make_scene(key).name,
        method,
        *(f"{x:.3g}" for pair in zip(largest, usual, strict=True) for x in pair),
        str(exceeds.sum()),
        *(str((causes[exceeds] == i).sum()) for i in range(len(CAUSES))),
        CAUSES[causes[at_largest]] if exceeds.any() else "–",
        f"{found.chain_gain.max():.3g}",
    ]


def _measure(key: str, steps: int, methods: tuple[str, ...]) -> dict[str, Steps]:
    return measure(make_scene(key), steps, methods)


def main() -> None:
    """Prints the table, and writes the page if asked to."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--scenes", nargs="*", default=[*SCENES], choices=SCENES)
    parser.add_argument("--methods", nargs="*", default=METHODS, choices=METHODS)
    parser.add_argument("--steps", type=int, default=100_000)
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    args = parser.parse_args()
    rows = []
    print(*TITLES, sep=" | ", flush=True)
    with ProcessPoolExecutor(args.jobs) as pool:
        jobs = [
            pool.submit(_measure, key, args.steps, tuple(args.methods))
            for key in args.scenes
        ]
        for key, job in zip(args.scenes, jobs, strict=True):
            for method, found in job.result().items():
                rows.append(row(key, method, found))
                print(*rows[-1], sep=" | ", flush=True)
    if args.write:
        parts = {
            "walk": describe_walk(args.steps),
            "steps": make_steps(rows),
            "gains": describe_gains(),
        }
        write_parts(PAGE, parts, __file__)


if __name__ == "__main__":
    main()
