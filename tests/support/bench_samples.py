"""Figures of a benchmark that nobody has run."""

from __future__ import annotations

from drake_haptics.evaluation.benchmark.benchmark import BenchFigures
from drake_haptics.evaluation.benchmark.pair_runs import PairFigures
from drake_haptics.evaluation.benchmark.python_pairs import PythonFigures
from drake_haptics.evaluation.benchmark.scene_runs import SceneFigures
from drake_haptics.evaluation.measuring.timing import TickTimes


def pair(library: str, size: int, median: float, kind: str = "ball") -> PairFigures:
    return PairFigures(
        kind=kind,
        size=size,
        library=library,
        ours=library == "ours",
        apart=TickTimes(10, median, 2 * median, 3 * median),
        in_depth=TickTimes(10, 3 * median, 4 * median, 5 * median),
        max_relative_error=1e-12,
        wrong_share=0.0,
        exact_depth_share=1.0,
        max_jump_deg=0.5,
        failed_frames=0,
    )


def scene(library: str, near: TickTimes) -> SceneFigures:
    return SceneFigures("cup", library, 840, 55, 75, 1, near, near, 3.0, 7, 1e-3)


FIGURES = [
    *(pair("ours", 42, 0.1), pair("fast", 42, 1.0), pair("slow", 42, 4.0)),
    *(pair("ours", 2562, 0.2), pair("fast", 2562, 8.0), pair("slow", 2562, 5.0)),
]
EVERYTHING = BenchFigures(
    machine={
        "processor": "abacus",
        "cores": 1,
        "system": "wood",
        "python": "3",
        "drake_haptics": "1",
    },
    libraries={"drake_haptics, tracked": "1", "coal, cold": "3"},
    missing={"fcl": "No module named 'fcl'"},
    pairs=FIGURES,
    python=[PythonFigures("ball", 42, 0.5, 2.0)],
    scenes=[
        scene("drake_haptics", TickTimes(5, 2.0, 6.0, 6.0)),
        scene("coal, dynamic AABB tree", TickTimes(5, 20.0, 30.0, 30.0)),
    ],
)
