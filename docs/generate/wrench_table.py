"""Tabulates the wrenches of contacts that have a closed form.

python docs/generate/wrench_table.py --write
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from page_parts import make_parser, to_markdown
from page_stamp import write_page
from wrench_chain import (
    DAMPING_NS_PER_M,
    DELTA_M,
    METHODS,
    ROUND_OFF,
    STIFFNESS_N_PER_M,
    TOLERANCE_M,
    Case,
)
from wrench_friction import B_M, MU, R, friction_cone, stick_to_slip
from wrench_laws import (
    action_and_reaction,
    damping,
    groove,
    materials,
    torque_about_a_corner,
    two_posts,
    two_posts_of_one_object,
)
from wrench_scenarios import (
    cut_face,
    edge_on_plane,
    face_on_plane,
    peg_against_walls,
    sphere_on_plane,
)

PAGE = Path(__file__).parents[2] / "docs" / "verification" / "wrenches.md"
SCENARIOS: dict[str, Callable[[str], Iterator[Case]]] = {
    s.__name__: s
    for s in (
        sphere_on_plane,
        edge_on_plane,
        face_on_plane,
        peg_against_walls,
        torque_about_a_corner,
        two_posts,
        two_posts_of_one_object,
        groove,
        action_and_reaction,
        materials,
        damping,
        stick_to_slip,
        friction_cone,
    )
} | {f"face in {n}": partial(cut_face, pieces=n) for n in (1, 4, 50)}

_TEXT = """\
# Wrenches in closed form

**Are force and torque those of the formulas?** Yes: where contacts share stiffness, as
they do by default, they agree to round-off, and for a smooth sphere to the bound of its
tessellation.

The contacts below have a force and torque that are known on paper. The real chain
answers them: bodies cut into pieces, contact query, clusters, penalty force. This page
is written by

    python docs/generate/wrench_table.py --write

Tolerance t = {tolerance:g} mm, k = {stiffness:g} N/m, k_v = {damping:g} N·s/m;
friction has μ = {mu:g}, r = {r:g} (static over sliding) and b = {b:g} mm
(how far a contact gives way). Every scene stands askew in the world, and torques are
about a point of no symmetry. The error is the larger of |Δf| / |f| and |Δτ| / (|f| a),
a being the length that the tool has there; of scenarios with several poses, near and
penetrating, it is the largest. Tests hold every error at
{round_off:g}, and that of the smooth sphere at the bound of its tessellation. They do
not hold the octree to faces that are cut: it weighs the contacts of all pieces alike,
however little of the tool is over one.

{rows}

The octree's cells are {delta:g} mm, but 40 mm where the formula speaks of one cluster
and on faces that are cut.

The column *Eq. or section* names what of the paper a scenario follows. More tests hold
the same equations: `tests/core/pair/test_contact.py`,
`tests/core/law/test_clustering.py` and `tests/core/law/test_penalty_force.py`.
"""


def row(cases: dict[str, Case]) -> list[str]:
    """Returns the texts of a line: one scenario through each method that answers it."""
    shown = cases.get("shared") or cases["octree"]
    return [
        shown.scenario,
        shown.formula,
        shown.equations,
        *(f"{cases[m].error:.1e}" if m in cases else "–" for m in METHODS),
    ]


TITLES = ("scenario", "closed form", "Eq. or section")
TITLES += tuple(f"error, {method}" for method in METHODS)


def rows() -> Iterator[list[str]]:
    """Yields the lines of the table."""
    for scenario in SCENARIOS.values():
        by_name: dict[str, dict[str, Case]] = {}
        for method in METHODS:
            for case in scenario(method):
                by_name.setdefault(case.scenario, {})[method] = case
        yield from map(row, by_name.values())


def main() -> None:
    """Prints the table, and writes the page if asked to."""
    write = make_parser(__doc__, PAGE).parse_args().write
    table = to_markdown([TITLES, *rows()])
    print(table)
    if write:
        write_page(
            PAGE,
            _TEXT.format(
                tolerance=1e3 * TOLERANCE_M,
                stiffness=STIFFNESS_N_PER_M,
                damping=DAMPING_NS_PER_M,
                delta=1e3 * DELTA_M,
                round_off=ROUND_OFF,
                mu=MU,
                r=R,
                b=1e3 * B_M,
                rows=table.rstrip(),
            ),
            __file__,
        )


if __name__ == "__main__":
    main()
