"""Tabulates and draws the effect of a servo on a device: at stalls and at stiff walls.

python docs/generate/servo_table.py --write
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from page_parts import make_parser, to_markdown
from page_stamp import show_parts
from servo_loop import (
    FAST_SERVO,
    HELD,
    LOCAL,
    NOMINAL_HAND,
    ONE_SIDED,
    SCHEMES,
    SERVO,
    UNBRAKED,
    Run,
    simulate,
)
from solved_wall import (
    SOLVERS,
    calc_spectral_radius,
    comes_to_rest,
    comes_to_rest_in_drake,
    find_largest_stiffness,
)

from drake_haptics.common.colors import FORCE_INK, HANDLE_GHOST

_DOCS = Path(__file__).parents[2] / "docs"
PAGE = _DOCS / "servo.md"
TRACES = _DOCS / "servo_stall.png"
STIFFNESSES = (500, 1000, 1500, 2000, 3000)
HANDS = {"nobody holds it": None, "nominal hand": NOMINAL_HAND}
# Below this nothing is felt.
BUZZ_M = 1e-4
WILD_M = 0.02


def make_parts() -> str:
    """Returns the effects of the law's parts, without the link's sample of delay."""
    rows = [["scheme", "K, N/m", "stalls of", "motion at the end", "farthest"]]
    for scheme, K, stall_s in [
        (HELD, 500, 0.0),
        (LOCAL, 500, 0.0),
        (UNBRAKED, 500, 0.2),
        (SERVO, 500, 0.2),
        (UNBRAKED, 1500, 0.2),
        (SERVO, 1500, 0.2),
        (ONE_SIDED, 1500, 0.0),
    ]:
        run = simulate(scheme, K, 100, stall_s, delay=0, stall_period_s=0.5)
        last = run.x_m[run.time_s >= run.time_s[-1] - 0.5]
        rows.append(
            [
                scheme.name,
                f"{K}",
                f"{1e3 * stall_s:.0f} ms" if stall_s else "none",
                _millimeters(np.ptp(last)),
                _millimeters(np.abs(run.x_m).max()),
            ]
        )
    return to_markdown(rows)


def make_stalls() -> str:
    """Returns buzz and stale force at the slowest loop and the measured stall.

    A fast servo has a sentence, as it neither buzzes nor holds a force.
    """
    schemes = [scheme for scheme in SCHEMES if scheme is not FAST_SERVO]
    rows = [["held by", "K, N/m", *(scheme.name for scheme in schemes)]]
    fast = []
    for name, hand in HANDS.items():
        for K in STIFFNESSES:
            runs = {x: simulate(x, K, 100, 0.121, hand=hand) for x in SCHEMES}
            fast.append(runs[FAST_SERVO])
            rows.append([name, f"{K}", *(_tell(runs[scheme]) for scheme in schemes)])
    told = f"The servo at 4 kHz in the worst of these: {_tell(*fast)}.\n"
    return f"{to_markdown(rows)}\n{told}"


def _tell(*runs: Run) -> str:
    buzz_m = max(run.calc_buzz() for run in runs)
    stale_N = max(run.calc_stale_force() for run in runs)
    return f"{_millimeters(buzz_m)}, {stale_N:.1f} N"


def make_walls() -> str:
    """Returns the stiffest wall that is stable, in theory, linearized and simulated."""
    rows = [["contact", "theory", "linearization", "simulated servo", "loop in Drake"]]
    for solver in SOLVERS:
        judges = [
            lambda K, solver=solver: calc_spectral_radius(solver, K) < 1.0,
            lambda K, solver=solver: comes_to_rest(solver, K),
        ]
        if solver.every == 1:
            judges.append(lambda K, solver=solver: comes_to_rest_in_drake(solver, K))
        theory = solver.calc_theory()
        limits = [f"{find_largest_stiffness(judge, theory):.0f}" for judge in judges]
        row = [solver.name, f"{theory:.0f}", *limits]
        rows.append([*row, *["–"] * (5 - len(row))])
    return to_markdown(rows)


def _millimeters(length_m: float) -> str:
    if length_m < BUZZ_M:
        return "still"
    # What is wilder has no figure that means anything.
    return f"{1e3 * length_m:.1f} mm" if length_m < WILD_M else "over 20 mm"


# The tests make the first two again, and check the limits of the walls.
TABLES: dict[str, Callable[[], str]] = {"stalls": make_stalls, "parts": make_parts}


def draw_traces() -> None:
    """Draws one stall in a nominal hand that presses on a wall."""
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, 4, figsize=(8.0, 4.2), sharex=True, sharey="row")
    for column, scheme in zip(axes.T, SCHEMES, strict=True):
        run = simulate(scheme, 1500, 100, 0.121, hand=NOMINAL_HAND)
        shown = (run.time_s >= 1.8) & (run.time_s < 2.6)
        drawn = ((1e3 * run.x_m, HANDLE_GHOST[:3]), (run.force_N, FORCE_INK))
        for axis, (values, color) in zip(column, drawn, strict=True):
            axis.axvspan(2.0, 2.121, color="0.85")
            axis.plot(run.time_s[shown], values[shown], color=color, linewidth=0.9)
        column[0].set_title(scheme.name)
        column[1].set_xlabel("time, s")
    axes[0, 0].set_ylabel("handle, mm into the wall")
    axes[1, 0].set_ylabel("force, N")
    figure.tight_layout()
    figure.savefig(TRACES, dpi=110)


def main() -> None:
    """Prints the tables, and writes page and pictures if asked to."""
    write = make_parser(__doc__, PAGE).parse_args().write
    tables = {name: make() for name, make in TABLES.items()} | {"walls": make_walls()}
    show_parts(PAGE, tables, __file__, write)
    if write:
        matplotlib.use("Agg")
        draw_traces()


if __name__ == "__main__":
    main()
