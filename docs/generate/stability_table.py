"""Tabulates the stability of shipped scenes, and draws one of them.

python docs/generate/stability_table.py --write
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import get_args

from page_parts import make_parser, to_markdown
from page_stamp import show_parts

from drake_haptics.analysis.scene_stability import SceneStability, analyze_scene
from drake_haptics.analysis.stability_page import describe_delay
from drake_haptics.analysis.stiffness_limits import Against, format_limit
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

_DOCS = Path(__file__).parents[2] / "docs"
PAGE = _DOCS / "stability.md"
PICTURE = _DOCS / "stability_cup_spoon.png"
SCENES = ("cup_spoon", "torus_peg", "can_box")
DRAWN = "cup_spoon"
_MAP_SIZE = 20
_DPI = 80

AGAINST = get_args(Against)
Results = dict[str, SceneStability]


def make_places(results: Results) -> str:
    """Returns where each scene is held, and the figures that are not limits."""
    rows = [
        [
            "scene",
            "held at, s",
            "contacts",
            "force, N",
            "growth per tick",
            "further delay",
            "passivity needs",
        ]
    ]
    for name, found in results.items():
        rows.append(
            [
                name,
                f"{found.time_s:.3f}",
                f"{found.num_contacts}",
                f"{found.contact_force_N:.2f}",
                f"{found.growth:.5f}",
                describe_delay(found),
                f"{100.0 * found.damping_usage.max():.1f} % of the damping",
            ]
        )
    return to_markdown(rows)


def make_limits(results: Results) -> str:
    """Returns the largest stable stiffnesses, and how far simulations differ."""
    rows = [["scene", "stiffness", "scene's", *AGAINST, "one axis", "formula"]]
    differences = []
    for name, found in results.items():
        for kind in dict.fromkeys(limit.kind for limit in found.limits):
            limits = {x.against: x for x in found.limits if x.kind == kind}
            # One axis and the formula are of a wall.
            wall = limits["a rigid wall"]
            values = [
                wall.stiffness,
                *(limits[against].eigenvalue for against in AGAINST),
            ]
            values += [wall.one_axis, wall.formula]
            rows.append([name, f"{kind}, {wall.unit}", *map(format_limit, values)])
            differences += [
                abs(x.simulated / x.eigenvalue - 1) for x in limits.values()
            ]
    told = max(difference for difference in differences if math.isfinite(difference))
    return (
        f"{to_markdown(rows)}\nThe limits of simulations differ from those of"
        f" eigenvalues by at most {100.0 * told:.2f} %.\n"
    )


PARTS = {"places": make_places, "limits": make_limits}


def analyze(name: str, map_size: int = 0) -> SceneStability:
    """Returns the stability of a shipped scene at its firmest contact."""
    print(name, file=sys.stderr)
    return analyze_scene(load_scene(find_scene(name)), map_size=map_size)


def main() -> None:
    """Prints the tables, and writes page and picture if asked to."""
    write = make_parser(__doc__, PAGE, PICTURE).parse_args().write
    results = {
        name: analyze(name, _MAP_SIZE if write and name == DRAWN else 0)
        for name in SCENES
    }
    parts = {name: make(results) for name, make in PARTS.items()}
    show_parts(PAGE, parts, __file__, write)
    if write:
        results[DRAWN].plot().savefig(PICTURE, dpi=_DPI)


if __name__ == "__main__":
    main()
