"""The table of what scenes cost."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from drake_haptics.evaluation.benchmark.scene_runs import NAME, SceneFigures
from drake_haptics.report.page import Table


def scene_table(figures: Sequence[SceneFigures]) -> Table:
    """Returns times and sizes of the scenes, this package and its peer."""
    return Table(
        title="Scenes: times of a whole query in µs, median / p99",
        note=(
            "Over the ticks in which all libraries find a contact within 2 mm, on the "
            "same convex pieces: of the tool, of all objects. Contacts: median, most. "
            "coal: dynamic AABB trees, the tool's boxes grown by "
            "2 mm, and the signed distance of each pair whose boxes overlap, in C++. "
            "Its contacts include those on facets that are not on the mesh, which "
            "this package leaves out."
        ),
        header=(
            "scene",
            "pieces",
            "contacts",
            "ours",
            "coal",
            "ratio",
        ),
        rows=[
            _row({f.library: f for f in group})
            for _, group in groupby(figures, key=lambda f: f.scene)
        ],
    )


def _row(by_library: dict[str, SceneFigures]) -> tuple[str, ...]:
    ours = by_library[NAME]
    peers = [f for name, f in by_library.items() if name != NAME]
    coal, ratio = "–", "–"
    if peers:
        near = peers[0].near
        coal = f"{near.median_us:.1f} / {near.p99_us:.1f}"
        ratio = (
            f"{ours.near.median_us / near.median_us:.2f}"
            f" / {ours.near.p99_us / near.p99_us:.2f}"
        )
    return (
        ours.scene,
        f"{ours.tool_pieces}, {ours.object_pieces}",
        f"{ours.median_contacts:.0f}–{ours.max_contacts}",
        f"{ours.near.median_us:.1f} / {ours.near.p99_us:.1f}",
        coal,
        ratio,
    )
