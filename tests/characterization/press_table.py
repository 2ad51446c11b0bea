"""Prints how presses and jabs with many tools on many solids end.

python tests/characterization/press_table.py --points 40 --gains sinking
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from mesh_samples import REAL_MESHES
from press_rig import (
    GAINS,
    LARGEST_FORCE_N,
    MODELS,
    MOTIONS,
    Gains,
    make_tools,
    sample_presses,
)
from press_verdict import Verdict, judge
from solid_surface import Overlap, Surface

from drake_haptics.decomposition import decompose
from drake_haptics.mesh import load_mesh

SHIPPED = ("cup", "spoon", "torus", "hammer", "block", "peg", "pen", "sphere")
REAL = ("cup_500.obj", "torus_2000.obj", "mug.stl")
HEADER = (
    f"{'solid':12} {'tool':6} {'motion':8} {'gains':8} {'n':>4} {'lost%':>6} "
    f"{'inwd%':>6} {'made%':>6} {'thru%':>6} {'hook%':>6} {'shall%':>6} "
    f"{'depth mm':>8} "
    f"{'jump N':>7} {'rest uJ':>8} {'drift um':>8}"
)


def find_mesh(name: str) -> Path | None:
    """The file of a solid by name; None if it is not there."""
    path = MODELS / f"{name}.obj" if name in SHIPPED else REAL_MESHES / name
    return path if path.exists() else None


def makes_energy(verdict: Verdict, gains: Gains) -> bool:
    """Whether the contact gave more than the largest force stores in its spring."""
    return verdict.made_J > 0.5 * LARGEST_FORCE_N**2 / gains.stiffness_N_per_m


def row(verdicts: list[Verdict], gains: Gains) -> str:
    """The figures of a cell of the table."""
    done = [v for v in verdicts if not v.skipped]
    if not done:
        return f"{0:4d}  no press met the solid"

    def share(bad):
        return 100.0 * sum(map(bad, done)) / len(done)

    def worst(value, factor):
        return factor * max(map(value, done))

    return (
        f"{len(done):4d} {share(lambda v: v.lost_tick >= 0):6.1f} "
        f"{share(lambda v: v.inward_tick >= 0):6.1f} "
        f"{share(lambda v: makes_energy(v, gains)):6.1f} "
        f"{share(lambda v: v.through):6.1f} "
        f"{share(lambda v: v.hooked_m > 1e-3):6.1f} "
        f"{share(lambda v: v.shallow < 0.8):6.1f} "
        f"{worst(lambda v: v.depth_m, 1e3):8.2f} "
        f"{np.percentile([v.jump_N for v in done], 90):7.2f} "
        f"{np.percentile([v.rest_J for v in done], 90) * 1e6:8.3f} "
        f"{np.percentile([v.drift_m for v in done], 90) * 1e6:8.2f}"
        + ("" if all(v.finite for v in done) else " NaN!")
    )


def complaints(verdict: Verdict, gains: Gains) -> str:
    """Why a press failed, or nothing."""
    found = []
    if verdict.lost_tick >= 0:
        found.append(f"lost at tick {verdict.lost_tick}")
    if verdict.inward_tick >= 0:
        found.append(f"inward at tick {verdict.inward_tick}")
    if makes_energy(verdict, gains):
        found.append(
            f"made {1e3 * verdict.made_J:.1f} mJ by tick {verdict.ticks['made']}"
        )
    if verdict.through:
        found.append("through")
    if verdict.hooked_m > 1e-3:
        found.append(f"hooked {1e3 * verdict.hooked_m:.1f} mm")
    if verdict.shallow < 0.8:
        found.append(f"shallow {verdict.shallow:.2f}")
    if not verdict.finite:
        found.append("NaN")
    return ", ".join(found)


def main() -> None:
    """Runs the presses that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=40)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--solids", nargs="*", default=[*SHIPPED, *REAL])
    parser.add_argument("--tools", nargs="*")
    parser.add_argument("--motions", nargs="*", default=MOTIONS)
    parser.add_argument("--gains", nargs="*", default=list(GAINS))
    parser.add_argument("--failures", type=Path, help="file that gets each failure")
    args = parser.parse_args()
    tools = make_tools()
    failures = args.failures.open("a") if args.failures else None
    print(HEADER, flush=True)
    for name in args.solids:
        path = find_mesh(name)
        if path is None:
            print(f"{name:12} is not beside the repository: skipped")
            continue
        mesh = load_mesh(path, scale=1.0)
        solid, pieces = Surface(mesh), decompose(mesh).core
        for tool_name in args.tools or tools:
            tool = tools[tool_name]
            overlap = Overlap(tool.mesh, solid)
            for motion in args.motions:
                presses = sample_presses(mesh, tool, motion, args.points, args.seed)
                for gains in args.gains:
                    start = time.perf_counter()
                    verdicts = []
                    for i, press in enumerate(presses):
                        verdicts.append(
                            judge(press, tool, solid, pieces, GAINS[gains], overlap)
                        )
                        if sys.stderr.isatty():
                            print(f"\r{i + 1}/{len(presses)}", end="", file=sys.stderr)
                        why = complaints(verdicts[-1], GAINS[gains])
                        if why and failures:
                            print(
                                f"{name} {tool_name} {motion} {gains} seed {args.seed} "
                                f"point {i}: {why}",
                                file=failures,
                                flush=True,
                            )
                    label = f"{name:12} {tool_name:6} {motion:8} {gains:8}"
                    seconds = time.perf_counter() - start
                    print(
                        f"\r{label} {row(verdicts, GAINS[gains])} {seconds:.0f}s",
                        flush=True,
                    )


if __name__ == "__main__":
    main()
