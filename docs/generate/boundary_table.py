"""Tabulates the exact stability of sampled walls, and draws their boundary.

python docs/generate/boundary_table.py --write
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

import matplotlib

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from page_parts import make_parser, to_markdown
from page_stamp import show_parts
from wall_motion import HAND, NO_HAND, TABLE, find_simulated_limit, make_wall

from drake_haptics.analysis.exact_boundary import (
    calc_boundary_peak,
    calc_exact_alpha,
    calc_exact_boundary,
)
from drake_haptics.analysis.sampled_wall import SampledWall, calc_largest_stiffness
from drake_haptics.bounds.sampled_spring import (
    calc_passive_stiffness,
    calc_stable_stiffness,
)

_DOCS = Path(__file__).parents[2] / "docs"
PAGE = _DOCS / "stability-theory.md"
PICTURE = _DOCS / "stability_boundary.png"
DELAYS = range(5)
BETAS = (0.05, 0.1, 0.2)
MASS_KG, PERIOD_S = 0.1, 1e-3


def make_boundaries() -> str:
    """Returns the peak of each delay, and how far the loop's eigenvalues differ."""
    rows = [["delay d", "largest α", "at β", *(f"α at β = {x:g}" for x in BETAS)]]
    differences = []
    for d in DELAYS:
        peak = calc_boundary_peak(d)
        wall = SampledWall(
            mass=MASS_KG,
            damping=0.0,
            period_s=PERIOD_S,
            wall_damping=peak.beta * MASS_KG / PERIOD_S,
            delay_s=d * PERIOD_S,
        )
        K = peak.alpha * MASS_KG / PERIOD_S**2
        differences.append(abs(calc_largest_stiffness(wall) / K - 1))
        alphas = (f"{calc_exact_alpha(beta, d):.5f}" for beta in BETAS)
        rows.append([f"{d}", f"{peak.alpha:.6f}", f"{peak.beta:.5f}", *alphas])
    return f"{to_markdown(rows)}\n{_tell('Eigenvalues differ', differences)}"


def make_walls() -> str:
    """Returns limits of walls with damping and a hand, and how far they differ."""
    rows = [["b", "B", "delay d", "hand", "passive K", "law of Gil et al.", "exact K"]]
    differences = []
    for b, B, d, hand, *_ in TABLE:
        wall = make_wall(b, B, d, hand)
        held = b + wall.hand_damping
        passive = calc_passive_stiffness(held, B, wall.period_s, wall.delay_s)
        exact = calc_largest_stiffness(wall)
        differences.append(abs(find_simulated_limit(wall, exact) / exact - 1))
        rows.append(
            [
                f"{b:g}",
                f"{B:g}",
                f"{d}",
                {id(NO_HAND): "none", id(HAND): "0.2, 5, 300"}[id(hand)],
                f"{passive:.1f}" if passive > 0.0 else "none",
                f"{calc_stable_stiffness(held, B, wall.period_s, wall.delay_s):.1f}",
                f"{exact:.2f}",
            ]
        )
    return f"{to_markdown(rows)}\n{_tell('The simulation differs', differences)}"


def _tell(start: str, differences: Iterable[float]) -> str:
    return f"{start} by at most {max(differences):.0e} of K.\n"


PARTS = {"boundaries": make_boundaries, "walls": make_walls}


def draw() -> None:
    """Draws the boundaries, whole and near the origin."""
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (whole, near) = pyplot.subplots(1, 2, figsize=(10.0, 4.2))
    for d in DELAYS:
        boundary = calc_exact_boundary(d)
        boundary.plot(whole)
        boundary.plot(near)
    near.set_xlim(0.0, 0.4)
    near.set_ylim(0.0, 0.16)
    near.get_legend().remove()
    whole.set_xlim(0.0, 2.05)
    whole.set_ylim(0.0, 0.75)
    whole.legend(loc="center", bbox_to_anchor=(0.42, 0.5))
    whole.set_title("stable below each curve")
    near.set_title("near the origin; dotted: α = β/(½ + d)")
    figure.tight_layout()
    figure.savefig(PICTURE, dpi=110)


def main() -> None:
    """Prints the tables, and writes page and picture if asked to."""
    write = make_parser(__doc__, PAGE).parse_args().write
    parts = {name: make() for name, make in PARTS.items()}
    show_parts(PAGE, parts, __file__, write)
    if write:
        draw()


if __name__ == "__main__":
    main()
