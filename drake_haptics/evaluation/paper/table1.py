"""Cuts models like the paper's into convex pieces, as in its Table 1."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from drake_haptics.common.progress import Progress
from drake_haptics.evaluation.models import find_sources, load_model
from drake_haptics.evaluation.paper.published import TABLE_1
from drake_haptics.geometry.decomposition.decompose import decompose


@dataclass(frozen=True)
class ModelFigures:
    """A model like one of the paper's, and its pieces.

    The source is "own shape" or a file, and empty if there is no such model; the fields
    after it are figures of a `DecompositionReport`.
    """

    model: str
    paper_triangles: int
    paper_pieces: int
    source: str = ""
    triangles: int = 0
    pieces: int = 0
    flat_pieces: int = 0
    facets: int = 0
    virtual_facets: int = 0
    seconds: float = 0.0


def measure_table1(meshes: Path | None, progress: Progress) -> tuple[ModelFigures, ...]:
    """Cuts each model of the paper's Table 1, or models like it, in the paper's order.

    A model that is found in the folder of real meshes has a row below that of the
    package's shape. One that is neither in the package nor in the folder has one row
    with an empty source.
    """
    jobs = [
        (paper, source)
        for paper in TABLE_1
        for source in find_sources(paper.model, meshes) or [""]
    ]
    rows = []
    for k, (paper, source) in enumerate(jobs):

        def show(share: float, k: int = k, what: str = paper.model) -> None:
            progress(f"cut {what}", (k + share) / len(jobs))

        show(0.0)
        row = ModelFigures(paper.model, paper.triangles, paper.pieces)
        rows.append(_cut(row, source, meshes, show) if source else row)
    return tuple(rows)


def _cut(
    row: ModelFigures, source: str, meshes: Path | None, show: Callable[[float], None]
) -> ModelFigures:
    mesh = load_model(row.model, source, meshes)
    report = decompose(mesh, progress=show).report
    names = (
        "triangles",
        "pieces",
        "flat_pieces",
        "facets",
        "virtual_facets",
        "seconds",
    )
    return replace(
        row, source=source, **{name: getattr(report, name) for name in names}
    )
