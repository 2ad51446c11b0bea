"""Reports on a decomposition, as text and as data."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

from drake_haptics.common.one_line import count
from drake_haptics.geometry.mesh.report import length, write_text

# A mesh with more pieces is probably a scan, whose noise is concave everywhere.
_MANY_PIECES = 2000


@dataclass(frozen=True)
class DecompositionReport:
    """The outcome of a decomposition.

    Attributes:
        source: File or name of the mesh.
        method: "surface", "merged", "hull" or "coacd".
        triangles: Number of triangles of the mesh.
        one_sided_triangles: Number of triangles that do not bound a solid.
        pieces: Number of convex pieces.
        flat_pieces: Number of pieces without volume (coplanar patches, and needles
            thinner than the tolerance).
        facets: Number of facets of all pieces; a flat piece counts as one.
        virtual_facets: Number of facets that are not on the mesh.
        seconds: Time that it took to find the pieces, s.
        from_cache: Whether the pieces were found earlier and read from the cache or a
            file.
        departure_m: Bound on the departure of any merged piece from the mesh, m; None
            for other methods.
    """

    source: str
    method: str
    triangles: int
    one_sided_triangles: int
    pieces: int
    flat_pieces: int
    facets: int
    virtual_facets: int
    seconds: float
    from_cache: bool
    departure_m: float | None = None

    def to_dict(self) -> dict[str, Any]:
        """Returns plain data for JSON."""
        return asdict(self)

    def __rich_console__(
        self, console: Console, options: ConsoleOptions
    ) -> RenderResult:
        yield Text(self.source, style="bold")
        table = Table.grid(padding=(0, 2))
        table.add_row("  method", self.method)
        flat = f", {self.flat_pieces:,} of them flat" if self.flat_pieces else ""
        table.add_row(
            "  result",
            f"{count(self.pieces, 'piece')} from"
            f" {count(self.triangles, 'triangle')}{flat}",
        )
        table.add_row(
            "  facets",
            f"{self.facets:,}, {self.virtual_facets:,} of them virtual "
            f"(not on the mesh)",
        )
        if self.departure_m is not None:
            table.add_row("  error", f"within {length(self.departure_m)} of the mesh")
        when = "found earlier in" if self.from_cache else "found in"
        table.add_row("  time", f"{when} {_duration(self.seconds)}")
        yield table
        if self.one_sided_triangles:
            share = self.one_sided_triangles / self.triangles
            yield Text(
                f"  {count(self.one_sided_triangles, 'triangle')} ({share:.0%}) "
                f"{'bounds' if self.one_sided_triangles == 1 else 'bound'} no "
                f"solid: their pieces are one-sided and nothing can be inside. Closing "
                f"the holes of the mesh gives fewer pieces and an inside.",
                style="yellow",
            )
        if self.method == "surface" and self.pieces > _MANY_PIECES:
            yield Text(
                f"  {count(self.pieces, 'piece')} are many. Fewer are quicker to"
                " touch: reduce the mesh first, to 2000 triangles for instance, or take"
                " the method merged with an error of 1e-4 m, which joins pieces within"
                " 0.1 mm (minutes for a large mesh). A scene has max_triangles,"
                " decomposition and decomposition_error_m.",
                style="yellow",
            )

    __str__ = write_text


def _duration(seconds: float) -> str:
    return f"{seconds:.2f} s" if seconds >= 0.1 else f"{seconds * 1e3:.1f} ms"
