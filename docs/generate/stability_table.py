"""Tabulates the stability of shipped scenes, and draws one of them.

python docs/generate/stability_table.py --write
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from pathlib import Path

from page_parts import make_parser, replace_part, to_markdown
from page_stamp import write_page

from drake_haptics.analysis.scene_stability import SceneStability, analyze_scene
from drake_haptics.analysis.stability_page import describe_delay
from drake_haptics.analysis.stiffness_limits import format_limit
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

_DOCS = Path(__file__).parents[2] / "docs"
PAGE = _DOCS / "stability.md"
PICTURE = _DOCS / "stability_cup_spoon.png"
SCENES = ("cup_spoon", "torus_peg", "can_box")
DRAWN = "cup_spoon"
_MAP_SIZE = 20
_DPI = 80

Results = dict[str, SceneStability]


def place_rows(results: Results) -> Iterable[list[str]]:
    """Yields where each scene is held, and the figures that are not limits."""
    yield [
        "scene",
        "held at, s",
        "contacts",
        "force, N",
        "growth per tick",
        "further delay",
        "damping that passivity needs",
    ]
    for name, found in results.items():
        yield [
            name,
            f"{found.time_s:.3f}",
            f"{found.num_contacts}",
            f"{found.contact_force_N:.2f}",
            f"{found.growth:.5f}",
            describe_delay(found),
            f"{100.0 * found.damping_usage.max():.1f} % of what there is",
        ]


def limit_rows(results: Results) -> Iterable[list[str]]:
    """Yields the largest stable stiffness by each way, relative to the first."""
    yield [
        "scene",
        "stiffness",
        "against",
        "scene's",
        "eigenvalue",
        "simulation",
        "differs by",
        "one axis",
        "differs by",
        "formula",
        "differs by",
    ]
    for name, found in results.items():
        for limit in found.limits:
            cells = [name, f"{limit.kind}, {limit.unit}", limit.against]
            cells.append(format_limit(limit.stiffness))
            cells.append(format_limit(limit.eigenvalue))
            for value in (limit.simulated, limit.one_axis, limit.formula):
                cells.append(format_limit(value))
                cells.append(_to_percent(value / limit.eigenvalue - 1.0))
            yield cells


def _to_percent(share: float) -> str:
    """Returns hundredths of a percent, without a sign at 0."""
    return f"{round(100.0 * share, 2) + 0.0:.2f} %" if math.isfinite(share) else ""


TABLES = {"places": place_rows, "limits": limit_rows}


def with_tables(page: str, results: Results) -> str:
    """Returns the page with the present tables."""
    for name, rows in TABLES.items():
        table = to_markdown(rows(results))
        print(table)
        page = replace_part(page, table, name)
    return page


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
    page = with_tables(PAGE.read_text(encoding="utf-8"), results)
    if write:
        write_page(PAGE, page, __file__)
        results[DRAWN].plot().savefig(PICTURE, dpi=_DPI)


if __name__ == "__main__":
    main()
