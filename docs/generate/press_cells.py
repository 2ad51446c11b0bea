"""The cells of the press table: many presses on one solid, and their verdicts."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from mesh_samples import REAL_MESHES
from press_rig import GAINS, LARGEST_FORCE_N, Gains, sample_presses
from press_tools import MODELS, PressTool, make_tools
from press_verdict import Verdict, judge
from solid_surface import Overlap, Surface

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh

SHIPPED = ("block", "cup", "hammer", "peg", "pen", "sphere", "spoon", "torus")
REAL = ("cup_500.obj", "torus_2000.obj", "hammer_1692.obj")
# The flat tool of 2,000 pieces is left out: it costs more than all the others.
TOOLS = ("spike", "ball", "box", "spoon")


@dataclass(frozen=True)
class Cell:
    """Presses that belong together in the table.

    Attributes:
        solid: One of SHIPPED, or a file's name among the real meshes.
        tools: Names of the tools; point i is met by tool i modulo their number.
        motion: One of press_rig.MOTIONS.
        gains: One of press_rig.GAINS.
        seed: Seed of the random points.
    """

    solid: str
    tools: tuple[str, ...]
    motion: str
    gains: str
    seed: int


@dataclass(frozen=True)
class Column:
    """A column of the table: its title and its text for the presses that met."""

    title: str
    text: Callable[[list[Verdict], Gains], str]


def find_mesh(name: str) -> Path | None:
    """Returns the file of a solid by name; None if it is not there."""
    path = MODELS / f"{name}.obj" if name in SHIPPED else REAL_MESHES / name
    return path if path.exists() else None


def makes_energy(verdict: Verdict, gains: Gains) -> bool:
    """Tells whether contact gave more than the largest force stores in its spring."""
    return verdict.made_J > 0.5 * LARGEST_FORCE_N**2 / gains.stiffness_N_per_m


def run_points(cell: Cell, points: Iterable[int]) -> Iterator[tuple[int, Verdict]]:
    """Presses at the numbered points of a cell, one after the other."""
    mesh, surface, pieces = _solid(cell.solid)
    for i in points:
        name = cell.tools[i % len(cell.tools)]
        tool = _tools()[name]
        [press] = sample_presses(mesh, tool, cell.motion, [i], cell.seed)
        overlap = _overlap(cell.solid, name)
        yield i, judge(press, tool, surface, pieces, GAINS[cell.gains], overlap)


def complaints(verdict: Verdict, gains: Gains) -> str:
    """Returns why a press failed, or ""."""
    found = []
    if verdict.lost_tick >= 0:
        found.append(f"lost at tick {verdict.lost_tick}")
    if verdict.inward_tick >= 0:
        found.append(f"inward at tick {verdict.inward_tick}")
    if makes_energy(verdict, gains):
        found.append(f"made {1e3 * verdict.made_J:.1f} mJ by {verdict.made_tick}")
    if verdict.through:
        found.append("through")
    if verdict.hooked_m > 1e-3:
        found.append(f"hooked {1e3 * verdict.hooked_m:.1f} mm")
    if verdict.shallow < 0.8:
        found.append(f"shallow {verdict.shallow:.2f}")
    if verdict.jumps.distance or verdict.jumps.force:
        found.append(f"jumps {verdict.jumps}")
    if not verdict.finite:
        found.append("NaN")
    return ", ".join(found)


def _number_of(is_bad: Callable[[Verdict, Gains], bool]) -> Callable[..., str]:
    return lambda met, gains: str(sum(is_bad(v, gains) for v in met))


def _worst(value: Callable[[Verdict], float], digits: int) -> Callable[..., str]:
    return lambda met, gains: f"{max(map(value, met), default=0.0):.{digits}f}"


def _per_thousand(name: str) -> Callable[..., str]:
    """Returns a text of the jumps of a kind in a thousand ticks of contact."""

    def text(met: list[Verdict], gains: Gains) -> str:
        ticks = sum(v.jumps.ticks for v in met)
        return f"{1e3 * sum(getattr(v.jumps, name) for v in met) / max(1, ticks):.2f}"

    return text


COLUMNS = (
    Column("met", lambda met, gains: str(len(met))),
    Column("lost", _number_of(lambda v, g: v.lost_tick >= 0)),
    Column("inward", _number_of(lambda v, g: v.inward_tick >= 0)),
    Column("through", _number_of(lambda v, g: v.through)),
    Column("hooked", _number_of(lambda v, g: v.hooked_m > 1e-3)),
    Column("NaN", _number_of(lambda v, g: not v.finite)),
    Column("energy", _number_of(makes_energy)),
    Column("deepest mm", _worst(lambda v: 1e3 * v.depth_m, 2)),
    Column("distance jumps ‰", _per_thousand("distance")),
    Column("turns ‰", _per_thousand("turn")),
    Column("force jumps ‰", _per_thousand("force")),
    Column("of clusters ‰", _per_thousand("force_alone")),
    Column("largest N", _worst(lambda v: v.jumps.largest_N, 2)),
)


def row(cell: Cell, verdicts: Iterable[Verdict]) -> list[str]:
    """Returns a line of the table: the presses, and a text for each of COLUMNS."""
    met = [v for v in verdicts if not v.skipped]
    gains = GAINS[cell.gains]
    return [cell.solid, cell.motion, cell.gains, *(c.text(met, gains) for c in COLUMNS)]


TITLES = ["solid", "motion", "gains", *(c.title for c in COLUMNS)]


@cache
def _solid(name: str) -> tuple[Mesh, Surface, _core.ConvexPieces]:
    path = find_mesh(name)
    if path is None:
        raise FileNotFoundError(f"the mesh {name} is not beside the repository")
    mesh = load_mesh(path, scale=1.0)
    return mesh, Surface(mesh), decompose(mesh).core


@cache
def _tools() -> dict[str, PressTool]:
    return make_tools()


@cache
def _overlap(solid: str, tool: str) -> Overlap:
    return Overlap(_tools()[tool].mesh, _solid(solid)[1])
