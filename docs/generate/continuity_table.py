"""Tabulates how much the wrench changes in steps of a micrometer, and why it jumps.

python docs/generate/continuity_table.py --scenes box --steps 20000
python docs/generate/continuity_table.py --jobs 3 --write
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from continuity_rig import CAUSES, JUMP, Steps, measure
from continuity_scenes import SCENES, make_scene
from continuity_walk import EPISODE_STEPS
from page_stamp import write_page
from press_rig import GAINS, LARGEST_FORCE_N
from wrench_chain import METHODS

PAGE = Path(__file__).parents[2] / "docs" / "verification" / "continuity.md"
TITLES = ("scene", "method", "force", "99.9 %", "torque", "99.9 %", f"over {JUMP:g}")
TITLES += (*CAUSES, "of the largest", "chain alone")

_TEXT = """\
# How much the wrench changes in a micrometer

**Does the force jump when the tool moves by a micrometer?** Rarely: about one step in a
thousand changes it by more than ten times what the spring explains.

The wrench should be a Lipschitz function of the pose: in a hand, a force that jumps is
a knock. Here tools take {steps:,} random steps of about a micrometer in contact with
solids, around {episodes} random poses each, nowhere deeper than what carries
{force:g} N. This page is written by

    python docs/generate/continuity_table.py --steps {steps} --jobs 3 --write

- **force**: largest |ΔF| / (k |Δx|) of a step, where |Δx| is the largest displacement
  of a point of the tool; **torque**: largest |Δτ| / (k L |Δx|) about the tool's middle,
  L being the tool's largest radius about it. Both without damping. **99.9 %**: what all
  but one step in a thousand stay below. One spring that is pressed has a ratio of 1.
- **over {jump:g}**: steps with a ratio above {jump:g}, then how many of them the
  contact query explains, for a contact changed by more than {jump:g} times the motion:
  a pair of pieces **came or went** while it was compressed, its **distance** jumped,
  its **normal** turned (times its compression), its **point** shifted (times its
  compression over L), its **patch** changed (its compression times the share of its
  extent, or its flushness); and how many it does not, so that the **clusters** did it.
  Or nothing jumped and the wrench is just **steep**: no 32nd part of the step has half
  of the change.
- **of the largest**: the cause of the largest ratio.
- **chain alone**: largest ratio of a change of the wrench to the largest change of what
  it is made of, pose or contact: what clustering multiplies a change by.

{rows}

The scattered tips each press into a slab of their own, so that their contacts only ever
glide: what jumps there is the clustering. Elsewhere both methods see the same contacts
on the same walk. Somewhere inside every corner two ways out are equally long; there the
depth of a pair of pieces goes over to the shorter one and its normal turns, which no
clustering mends.

The word after a scene's name is that of its gains:

{gains}
"""


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


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    """Prints the table, and writes the page if asked to."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", nargs="*", default=[*SCENES], choices=SCENES)
    parser.add_argument("--methods", nargs="*", default=METHODS, choices=METHODS)
    parser.add_argument("--steps", type=int, default=100_000)
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument(
        "--write", action="store_true", help="write docs/verification/continuity.md"
    )
    args = parser.parse_args()
    lines = [_line(TITLES), "|" + "---|" * len(TITLES)]
    print(*lines, sep="\n", flush=True)
    with ProcessPoolExecutor(args.jobs) as pool:
        jobs = [
            pool.submit(_measure, key, args.steps, tuple(args.methods))
            for key in args.scenes
        ]
        for key, job in zip(args.scenes, jobs, strict=True):
            for method, found in job.result().items():
                lines.append(_line(row(key, method, found)))
                print(lines[-1], flush=True)
    if args.write:
        used = {name: GAINS[name] for name in ("default", "sinking", "soft")}
        write_page(
            PAGE,
            _TEXT.format(
                steps=args.steps,
                episodes=-(-args.steps // EPISODE_STEPS),
                force=LARGEST_FORCE_N,
                jump=JUMP,
                rows="\n".join(lines),
                gains="\n".join(
                    f"- {name}: tolerance {1e3 * g.tolerance_m:g} mm, stiffness "
                    f"{g.stiffness_N_per_m:g} N/m, δ {1e3 * g.delta_m:g} mm"
                    for name, g in used.items()
                ),
            ),
            __file__,
        )


if __name__ == "__main__":
    main()
