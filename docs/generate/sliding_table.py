"""Tabulates the force on a tool that slides over a face in pieces.

python docs/generate/sliding_table.py --write
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from page_parts import make_parser, to_markdown
from page_stamp import show_parts
from press_rig import GAINS
from scipy.spatial.transform import Rotation
from slide_rig import feel, make_slide_tools, slide, velocity
from slide_scenes import (
    fifty_pieces,
    fifty_pieces_path,
    pitted_block,
    pitted_block_path,
)

from drake_haptics import _core

PAGE = Path(__file__).parents[2] / "docs" / "verification" / "continuity.md"
HEIGHTS_M = (1e-3, -5e-4, -1.2e-3)
DELTAS_M = (1e-3, 2.5e-3, 5e-3, 1e-2, 2e-2, 4e-2)
UP = np.array([0.0, 0.0, 1.0])
# Ripples below this are round-off.
_LEAST_RIPPLE = 1e-4

_TEXT = """\
{slides} slides: {lost} ticks without a contact; the nearest contact's distance errs by
{distance_um:.1e} µm at most, and a component of a normal by {normal:.1e}. Where
contacts share stiffness, the normal force ripples by {shared:.3f} % (largest less
smallest over the mean); for any method the tangential force is {sideways:.3f} % of it.

The paper's clusters do ripple. **δ** is the ripple through the octree with clusters of
that size, the largest of {heights} heights. Contacts that are not in adjacent cells are
clusters of their own, and each pushes with its whole depth: a tool that is larger than
δ and than the pieces is pushed by as many clusters as it happens to cover. {smooth}

{rows}
Tolerance {tolerance:g} mm, stiffness {stiffness:g} N/m, 0.1 m/s.
"""


@dataclass(frozen=True)
class Slide:
    """The force on a tool at one height.

    Attributes:
        face: Name of the face.
        tool: Name of the tool.
        lost: Number of ticks without a contact.
        distance_m: Largest error of the nearest contact's distance.
        normal: Largest error of any component of any contact's normal.
        shared: Ripple of the normal force where contacts share stiffness.
        octree: Ripple of the normal force through the octree, for each of `DELTAS_M`.
        sideways: Largest tangential force over the mean normal force.
    """

    face: str
    tool: str
    lost: int
    distance_m: float
    normal: float
    shared: float
    octree: tuple[float, ...]
    sideways: float


def slide_over(
    face: str,
    solid: _core.ConvexPieces,
    path_at: Callable[[float], np.ndarray],
    tool: str,
    height_m: float,
) -> Slide:
    """Slides one tool at one height."""
    path = path_at(height_m)
    turned = Rotation.from_rotvec([0, 0, 0.7 * (face == "50 pieces")]).as_matrix()
    gains = GAINS["default"]
    chains = [("shared", gains)]
    chains += [("octree", replace(gains, delta_m=delta)) for delta in DELTAS_M]
    lost, distance, normal = 0, 0.0, 0.0
    forces = []
    body = make_slide_tools()[tool]
    for contacts in slide(body, solid, path, UP, turned, gains.tolerance_m):
        if len(contacts) == 0:
            lost += 1
        else:
            distance = max(distance, abs(contacts.distance.min() - height_m))
            normal = max(normal, float(np.abs(contacts.nhat_BA_W - UP).max()))
        forces.append([feel(contacts, *c, velocity(path)).force_W for c in chains])
    felt = np.array(forces)
    mean = felt[:, :, 2].mean(axis=0)
    ripple = np.ptp(felt[:, :, 2], axis=0) / mean
    sideways = (np.linalg.norm(felt[:, :, :2], axis=2).max(axis=0) / mean).max()
    shared, *octree = ripple
    return Slide(face, tool, lost, distance, normal, shared, tuple(octree), sideways)


HEAD = ["face", "tool", *(f"δ {1e3 * delta_m:g} mm" for delta_m in DELTAS_M)]


def make_rows(slides: Sequence[Slide]) -> list[list[str]]:
    """Returns the rows of tools that feel a ripple, the head first."""
    felt: dict[tuple[str, str], np.ndarray] = {}
    for one in slides:
        key = (one.face, one.tool)
        felt[key] = np.maximum(felt.get(key, 0.0), one.octree)
    rows = [
        [*key, *(f"{100.0 * ripple:.1f} %" for ripple in ripples)]
        for key, ripples in felt.items()
        if ripples.max() >= _LEAST_RIPPLE
    ]
    return [HEAD, *rows]


def make_seams(slides: Sequence[Slide]) -> str:
    """Returns the part of the page."""
    rows = make_rows(slides)
    rippled = {row[1] for row in rows[1:]}
    smooth = sorted({one.tool for one in slides} - rippled)
    gains = GAINS["default"]
    return _TEXT.format(
        slides=len(slides),
        heights=len(HEIGHTS_M),
        lost=sum(one.lost for one in slides),
        distance_um=1e6 * max(one.distance_m for one in slides),
        normal=max(one.normal for one in slides),
        shared=100.0 * max(one.shared for one in slides),
        sideways=100.0 * max(one.sideways for one in slides),
        smooth=f"Tools that feel no ripple: {', '.join(smooth)}.",
        rows=to_markdown(rows),
        tolerance=1e3 * gains.tolerance_m,
        stiffness=gains.stiffness_N_per_m,
    )


def main() -> None:
    """Prints the part, and with --write puts it into the page."""
    write = make_parser(__doc__, PAGE).parse_args().write
    scenes = [
        ("50 pieces", fifty_pieces(), fifty_pieces_path, list(make_slide_tools())),
        ("pitted block", pitted_block(), pitted_block_path, ["box", "ball", "edge"]),
    ]
    slides = []
    for face, solid, path_at, tools in scenes:
        for tool in tools:
            print(f"{face}: {tool}", file=sys.stderr)
            slides += [
                slide_over(face, solid, path_at, tool, height_m)
                for height_m in HEIGHTS_M
            ]
    text = make_seams(slides)
    show_parts(PAGE, {"seams": text}, __file__, write)


if __name__ == "__main__":
    main()
