"""Tabulates what each stage of load shedding saves, in scenes of few and many contacts.

python docs/generate/load_table.py --write
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from page_parts import make_parser, to_markdown
from page_stamp import show_parts

from drake_haptics import SceneTracker
from drake_haptics._core import penalty_force, share_stiffness, thin_contacts
from drake_haptics.evaluation.benchmark.scenes import SceneProblem, scene_makers
from drake_haptics.evaluation.measuring.timing import describe_machine

PAGE = Path(__file__).parents[2] / "docs" / "accuracy.md"
HEAD = ["scene", "left out", "contacts", "that push", "query, µs", "the rest, µs"]
SCENES = ("spoon on cup", "peg in hole", "wrench in machine room")
# What is left of the reach, and the cell as a share of the tool's size.
STAGES = {
    "nothing": (1.0, 0.0),
    "half of the near contacts' reach": (0.5, 0.0),
    "all far near-contacts": (0.25, 0.0),
    "and fine clusters": (0.25, 0.1),
}
REPEATS = 5


def measure(problem: SceneProblem, share: float, cell: float) -> list[float]:
    """Returns medians over the ticks in contact: contacts, clusters, µs, µs."""
    tracker = SceneTracker(problem.tool, problem.objects, problem.tolerance_m)
    for i, X_WO in enumerate(problem.X_WO):
        tracker.set_object_pose(i, X_WO)
    p_WO = problem.X_WO[:, :3, 3].copy()
    V_WO, V_WT = np.zeros((len(p_WO), 6)), np.zeros(6)
    gains = np.full(len(p_WO), 2000.0), np.full(len(p_WO), 4.0)
    cell_m = cell * float(np.linalg.norm(problem.tool.mesh.report.extent))
    reach_m = share * problem.tolerance_m
    rows = []
    for _ in range(REPEATS):
        tracker.reset()
        for X_WT in problem.motions[0]:
            contacts = tracker.query(X_WT, reach_m)
            start_s = time.perf_counter()
            pushing = thin_contacts(contacts, cell_m) if cell_m else contacts
            clusters = share_stiffness(pushing, reach_m)
            penalty_force(clusters, X_WT[:3, 3].copy(), V_WT, p_WO, V_WO, *gains)
            rest_s = time.perf_counter() - start_s
            rows.append((len(contacts), len(clusters), contacts.query_seconds, rest_s))
    ticks = np.array(rows).reshape(REPEATS, -1, 4)
    counts, seconds = ticks[0, :, :2], np.median(ticks[:, :, 2:], axis=0)
    touching = counts[:, 0] > 0
    return [
        *np.median(counts[touching], axis=0),
        *(1e6 * np.median(seconds[touching], axis=0)),
    ]


def rows() -> Iterator[list[str]]:
    """Yields the table's rows, the first one its head."""
    yield HEAD
    makers = scene_makers(motions=1)
    for name in SCENES:
        problem = makers[name]()
        for words, (share, cell) in STAGES.items():
            contacts, clusters, query_us, rest_us = measure(problem, share, cell)
            yield [
                name,
                words,
                f"{contacts:.0f}",
                f"{clusters:.0f}",
                f"{query_us:.1f}",
                f"{rest_us:.1f}",
            ]


def main() -> None:
    """Prints the table, and with --write puts it into the page."""
    write = make_parser(__doc__, PAGE).parse_args().write
    machine = describe_machine()
    table = (
        f"{machine['processor']}, {machine['cores']} cores, {machine['system']}; noisy."
        f" Medians over the ticks in contact.\n\n{to_markdown(rows())}"
    )
    show_parts(PAGE, {"stages": table}, __file__, write)


if __name__ == "__main__":
    main()
