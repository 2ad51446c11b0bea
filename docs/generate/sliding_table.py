"""Tabulates what a tool feels that slides over a face in pieces.

python docs/generate/sliding_table.py --write
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from page_parts import make_parser
from page_stamp import write_page
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

PAGE = Path(__file__).parents[2] / "docs" / "verification" / "sliding.md"
HEIGHTS_M = (1e-3, -5e-4, -1.2e-3)
DELTAS_M = (1e-3, 2.5e-3, 5e-3, 1e-2, 2e-2, 4e-2)
UP = np.array([0.0, 0.0, 1.0])

_TEXT = """\
# Sliding over seams

**Does a person feel the seams between the pieces of a flat face?** No: where contacts
share stiffness, as they do by default, the force has no ripple, and every tick has a
contact.

A tool is held level at a height over a flat face that is cut into pieces, and slides.
The face is one plane, so each contact should have its normal and the nearest its
distance, and the force should stay as it is. This page is written by

    python docs/generate/sliding_table.py --write

- **distance** and **normal**: largest error of the nearest contact's distance, and of
  any component of any contact's normal, on all ticks: the contact query alone.
- **lost**: ticks without a contact.
- **shared**: ripple of the normal force, largest less smallest over the mean, where
  contacts share stiffness: what the chain makes of them.
- **δ**: the same through the octree with clusters of that size. Contacts that are not
  in adjacent cells are clusters of their own, and each pushes with its whole depth: a
  tool that is larger than δ and than the pieces is pushed by as many clusters as it
  happens to cover.
- **sideways**: largest tangential force over the mean normal force, for any of them.

{rows}

Tolerance {tolerance:g} mm, stiffness {stiffness:g} N/m, 0.1 m/s.
"""


def row(
    name: str,
    solid: _core.ConvexPieces,
    path_at: Callable[[float], np.ndarray],
    tool: str,
    height_m: float,
) -> list[str]:
    """The texts of a line: one tool at one height."""
    path = path_at(height_m)
    turned = Rotation.from_rotvec([0, 0, 0.7 * (name == "50 pieces")]).as_matrix()
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
    return [
        name,
        tool,
        f"{1e3 * height_m:g} mm",
        str(lost),
        f"{1e6 * distance:.1e} µm",
        f"{normal:.1e}",
        *(f"{100 * r:.3f} %" for r in ripple),
        f"{100 * sideways:.3f} %",
    ]


TITLES = ["face", "tool", "height", "lost", "distance", "normal", "shared"]
TITLES += [*(f"δ {1e3 * d:g} mm" for d in DELTAS_M), "sideways"]


def main() -> None:
    """Prints the table, and writes the page if asked to."""
    write = make_parser(__doc__, PAGE).parse_args().write
    scenes = [
        ("50 pieces", fifty_pieces(), fifty_pieces_path, list(make_slide_tools())),
        ("pitted block", pitted_block(), pitted_block_path, ["box", "ball", "edge"]),
    ]
    lines = ["| " + " | ".join(TITLES) + " |", "|" + "---|" * len(TITLES)]
    print(*lines, sep="\n")
    for name, solid, path_at, tools in scenes:
        for tool in tools:
            for height_m in HEIGHTS_M:
                texts = row(name, solid, path_at, tool, height_m)
                lines.append("| " + " | ".join(texts) + " |")
                print(lines[-1], flush=True)
    if write:
        gains = GAINS["default"]
        write_page(
            PAGE,
            _TEXT.format(
                rows="\n".join(lines),
                tolerance=1e3 * gains.tolerance_m,
                stiffness=gains.stiffness_N_per_m,
            ),
            __file__,
        )


if __name__ == "__main__":
    main()
