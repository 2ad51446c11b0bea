"""Cuts models like the paper's into convex pieces, as its Table 1 does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from drake_haptics.evaluation.models import find_sources, load_model
from drake_haptics.evaluation.paper.published import TABLE_1
from drake_haptics.geometry.decomposition.decompose import decompose


@dataclass(frozen=True)
class ModelFigures:
    """A model like one of the paper's, and the pieces it is cut into.

    Attributes:
        model: Name of the model in the paper.
        paper_triangles: Triangles of the paper's model.
        paper_pieces: Pieces of the paper's model.
        source: "own shape", or the file; empty if there is no such model.
        triangles: Triangles of our model.
        pieces: Pieces of our model.
        flat_pieces: Pieces without volume.
        facets: Facets of all pieces; a flat piece counts as one.
        virtual_facets: Facets that are not on the mesh.
        seconds: Time of finding the pieces, s, now or when they were first found.
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


def measure_table1(
    meshes: Path | None, progress: Callable[[str, float], None]
) -> tuple[ModelFigures, ...]:
    """Cuts each model of the paper's Table 1, or the models that are like it.

    Args:
        meshes: Folder of real meshes; a model found there has a row of its own below
            that of the package's shape.
        progress: Callback that takes the current work and the share done, in [0, 1].

    Returns:
        Rows in the paper's order. A model that is neither a shape of the package nor
        in the folder has one row with an empty source.
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
    """Returns a row with our figures."""
    mesh = load_model(row.model, source, meshes)
    report = decompose(mesh, progress=show).report
    return replace(
        row,
        source=source,
        triangles=report.triangles,
        pieces=report.pieces,
        flat_pieces=report.flat_pieces,
        facets=report.facets,
        virtual_facets=report.virtual_facets,
        seconds=report.seconds,
    )
