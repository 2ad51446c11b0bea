"""Reports what was found in a mesh and what was done, as text and as data."""

from __future__ import annotations

import io
from dataclasses import asdict, dataclass, fields
from enum import Enum
from typing import Any

from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

from drake_haptics.common.one_line import count


class Severity(str, Enum):
    """The severity of a finding.

    NOTE: Statement about the file; its surface is unchanged.
    QUESTION: Possible mistake that only its author can judge.
    REPAIRED: Defect of the surface, repaired.
    DEFECT: Defect of the surface, left as it is.
    """

    NOTE = "note"
    QUESTION = "question"
    REPAIRED = "repaired"
    DEFECT = "defect"


def write_text(report: object) -> str:
    """Returns a report that rich can draw as text of 80 columns, without colors."""
    out = io.StringIO()
    # In a notebook rich would display it instead of returning text.
    console = Console(file=out, width=80, color_system=None, force_jupyter=False)
    console.print(report)
    return "\n".join(line.rstrip() for line in out.getvalue().splitlines())


_COLORS = {
    Severity.DEFECT: "red",
    Severity.QUESTION: "magenta",
    Severity.REPAIRED: "yellow",
    Severity.NOTE: "cyan",
}


_NOT_LOOKED_FOR = (
    "Not looked for: places where the surface passes through itself; depth is not"
    " defined there."
)


@dataclass(frozen=True)
class Finding:
    """One thing found in a mesh.

    Attributes:
        code: Stable name, such as "duplicate-faces".
        severity: Severity of the finding.
        count: Number of occurrences.
        message: Description of the finding.
        action: Description of what was done.
    """

    code: str
    severity: Severity
    count: int
    message: str
    action: str

    def to_dict(self) -> dict[str, Any]:
        """Returns plain data for JSON."""
        return {**asdict(self), "severity": self.severity.value}

    @staticmethod
    def from_dict(data: dict[str, Any]) -> Finding:
        """Reads the data of `to_dict`."""
        return Finding(**{**data, "severity": Severity(data["severity"])})


class Findings(list[Finding]):
    """The findings of an intake, in the order in which they are made."""

    def add(
        self, code: str, severity: Severity, count: int, message: str, action: str
    ) -> None:
        """Adds a finding, unless its count is 0."""
        if count:
            self.append(Finding(code, severity, count, message, action))


# Keys in plain data that differ from the names of their attributes.
_KEYS = {"extent": "extent_m", "area": "area_m2", "volume": "volume_m3"}


@dataclass(frozen=True)
class MeshReport:
    """Size and kind of a mesh, and every finding of its intake.

    Attributes:
        source: File or name of the mesh.
        meters_per_unit: Factor from the file's unit to meters.
        vertices: Number of vertices after intake.
        triangles: Number of triangles after intake.
        components: Number of connected parts.
        solids: Number of parts that bound a solid.
        one_sided_triangles: Number of triangles of parts that do not bound a solid.
        extent: Size (x, y, z) of the bounding box, m.
        area: Area of the surface, m².
        volume: Volume of the solids, m³, counted once for each; cavities subtract.
        findings: Findings in the order in which they were made.
        decimation_error_m: Bound on the distance between this surface and that of the
            file, m; 0 without decimation.
    """

    source: str
    meters_per_unit: float
    vertices: int
    triangles: int
    components: int
    solids: int
    one_sided_triangles: int
    extent: tuple[float, float, float]
    area: float
    volume: float
    findings: tuple[Finding, ...]
    decimation_error_m: float = 0.0

    @property
    def unclean(self) -> tuple[Finding, ...]:
        """The findings that a strict intake refuses: repairs and defects."""
        refused = (Severity.REPAIRED, Severity.DEFECT)
        return tuple(f for f in self.findings if f.severity in refused)

    @property
    def refusal(self) -> str:
        """The reason why a strict intake refuses an unclean mesh."""
        found = "; ".join(finding.message for finding in self.unclean)
        return (
            f"{self.source}: refused, because a strict intake repairs nothing: "
            f"{found}. Repair the file, or read it without strict"
        )

    @property
    def verdict(self) -> str:
        """One sentence that says how the mesh can be used."""
        if self.solids == self.components:
            cavities = sum(f.count for f in self.findings if f.code == "cavities")
            solids = self.solids - cavities
            plural = "one solid" if solids == 1 else count(solids, "solid")
            if cavities == 0:
                return f"Usable as {plural}: closed and wound outward."
            hollow = (
                "a cavity" if cavities == 1 else count(cavities, "cavity", "cavities")
            )
            return (
                f"Usable as {plural} with {hollow}: closed, with outer walls wound"
                " outward and cavity walls inward."
            )
        if self.solids == 0:
            return (
                "Usable as an open surface: no part of it bounds a solid, so every "
                "piece is one-sided and nothing can be inside."
            )
        share = self.one_sided_triangles / self.triangles
        return (
            f"Usable in part as a solid: {self.solids} of "
            f"{count(self.components, 'part')} bound a solid; the others "
            f"({share:.0%} of the triangles) are open surfaces whose pieces are "
            "one-sided."
        )

    def to_dict(self) -> dict[str, Any]:
        """Returns plain data for JSON; lengths in m, areas in m², volumes in m³."""
        data = {_KEYS.get(name, name): value for name, value in vars(self).items()}
        return {
            **data,
            "extent_m": list(self.extent),
            "findings": [finding.to_dict() for finding in self.findings],
            "verdict": self.verdict,
        }

    @staticmethod
    def from_dict(data: dict[str, Any]) -> MeshReport:
        """Reads the data of `to_dict`."""
        own = {
            field.name: _KEYS.get(field.name, field.name)
            for field in fields(MeshReport)
        }
        known = {name: data[key] for name, key in own.items() if key in data}
        x, y, z = data["extent_m"]
        findings = tuple(map(Finding.from_dict, data["findings"]))
        return MeshReport(**{**known, "extent": (x, y, z), "findings": findings})

    def __rich_console__(
        self, console: Console, options: ConsoleOptions
    ) -> RenderResult:
        yield Text(self.source, style="bold")
        yield self._facts()
        yield Text()
        if self.findings:
            yield self._findings()
            yield Text()
        yield Text(self.verdict, style="bold")
        if self.solids:
            yield Text(_NOT_LOOKED_FOR, style="dim")

    def _facts(self) -> Table:
        table = Table.grid(padding=(0, 2))
        table.add_row("  size", "{} x {} x {}".format(*map(length, self.extent)))
        table.add_row(
            "  surface",
            f"{count(self.triangles, 'triangle')}, "
            f"{count(self.vertices, 'vertex', 'vertices')}, "
            f"{count(self.components, 'part')}, {_power(self.area, 2)}",
        )
        if self.solids:
            table.add_row("  volume", _power(self.volume, 3))
        return table

    def _findings(self) -> Table:
        """The findings, most important first."""
        table = Table.grid(padding=(0, 2))
        order = list(_COLORS)
        for finding in sorted(self.findings, key=lambda f: order.index(f.severity)):
            sentence = Text(f"{finding.message}: {finding.action} ")
            sentence.append(f"[{finding.code}]", style="dim")
            severity = Text(f"  {finding.severity.value}", _COLORS[finding.severity])
            table.add_row(severity, sentence)
        return table

    __str__ = write_text


def length(meters: float) -> str:
    """Writes a length in its usual unit."""
    if meters >= 1 or meters == 0:
        return f"{meters:.4g} m"
    if meters >= 1e-3:
        return f"{meters * 1e3:.4g} mm"
    return f"{meters * 1e6:.4g} µm"


def _power(value: float, exponent: int) -> str:
    """Writes an area or a volume in its usual unit."""
    mark = {2: "²", 3: "³"}[exponent]
    # From a liter on, 0.001 m³ reads better than 1000 cm³.
    for least_m, unit, per_m in ((0.1, "m", 1), (0.01, "cm", 100)):
        if value >= least_m**exponent or value == 0:
            return f"{value * per_m**exponent:.4g} {unit}{mark}"
    return f"{value * 1000**exponent:.4g} mm{mark}"
