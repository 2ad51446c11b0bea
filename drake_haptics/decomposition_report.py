"""The report on a decomposition, in words and as data."""

from __future__ import annotations

import io
from dataclasses import asdict, dataclass
from typing import Any

from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

from drake_haptics.mesh_report import length


@dataclass(frozen=True)
class DecompositionReport:
    """What a mesh was cut into.

    Attributes:
        source: file or name of the mesh.
        method: "surface", "merged", "hull" or "coacd".
        triangles: of the mesh.
        one_sided_triangles: those that bound no solid.
        pieces: convex pieces.
        flat_pieces: those of them without volume (coplanar patches, and needles
            thinner than the tolerance).
        facets: of all pieces; a flat piece counts as one.
        virtual_facets: those of them that are not on the mesh.
        seconds: that finding the pieces took, s.
        from_cache: the pieces were found earlier and read from the cache or a file.
        departure_m: of merged pieces: a bound on how far any of them departs from the
            mesh, m; None for other methods.
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
        pieces = "1 piece" if self.pieces == 1 else f"{self.pieces:,} pieces"
        flat = f", {self.flat_pieces:,} of them flat" if self.flat_pieces else ""
        table.add_row(
            "  result",
            f"{pieces} from {self.triangles:,} triangles{flat}",
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
                f"  {self.one_sided_triangles:,} triangles ({share:.0%}) bound no "
                f"solid: their pieces are one-sided and nothing can be inside. Closing "
                f"the holes of the mesh gives fewer pieces and an inside.",
                style="yellow",
            )

    def __str__(self) -> str:
        out = io.StringIO()
        # In a notebook rich would show it at once and leave nothing to return.
        console = Console(file=out, width=80, color_system=None, force_jupyter=False)
        console.print(self)
        return "\n".join(line.rstrip() for line in out.getvalue().splitlines())


def _duration(seconds: float) -> str:
    return f"{seconds:.2f} s" if seconds >= 0.1 else f"{seconds * 1e3:.1f} ms"
