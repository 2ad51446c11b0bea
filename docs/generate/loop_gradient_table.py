"""Tabulates how well the derivatives of whole scenes agree with differences.

python docs/generate/loop_gradient_table.py --write
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from loop_gradients import LoopGradients, build_scene, calc_gradients, contact_states
from page_parts import make_parser, to_markdown
from page_stamp import write_page

from drake_haptics.analysis.diagram_systems import walk_leaves

PAGE = Path(__file__).parents[2] / "docs" / "gradients.md"
MARK = "<!-- written by docs/generate/loop_gradient_table.py -->\n"
SCENES = (
    ("can_box",),
    ("cup_spoon",),
    ("hammer_block",),
    ("rubbed_sphere",),
    ("sphere_pen",),
    ("torus_peg",),
    ("cup_spoon", "contact.law=constraint"),
)
NUM_STATES = 12
UNTIL_S = 3.0
TITLES = (
    "scene",
    "systems",
    "numbers of state",
    "columns compared",
    "at a kink",
    "update: median",
    "99 %",
    "largest",
    "rates: median",
    "99 %",
    "largest",
)


def rows() -> Iterator[tuple[str, ...]]:
    """Yields a line for each scene, of all its states together."""
    yield TITLES
    for name, *settings in SCENES:
        loop = build_scene(name, *settings)
        found = [
            calc_gradients(loop, context)
            for context in contact_states(loop, NUM_STATES, UNTIL_S)
        ]
        kinks = sum(int(gradients.is_kink.sum()) for gradients in found)
        columns = sum(int(gradients.is_varied.sum()) for gradients in found)
        yield (
            ", ".join([name, *settings]),
            f"{len(list(walk_leaves(loop.diagram)))}",
            f"{found[0].is_kink.size}",
            f"{columns - kinks}",
            f"{kinks}",
            *_tell_errors(found, slice(None, found[0].num_updated)),
            *_tell_errors(found, slice(found[0].num_updated, None)),
        )


def _tell_errors(found: list[LoopGradients], part: slice) -> list[str]:
    """Returns quantiles of the errors of some rows, in all states.

    They are of the entries that are not zero; the largest error is that of all.
    """
    errors, expected = (
        np.concatenate([values(gradients)[part].ravel() for gradients in found])
        for values in (lambda g: g.errors, lambda g: g.expected)
    )
    told = ~np.isnan(expected)
    depends = told & (expected != 0.0)
    told_errors = [*np.quantile(errors[depends], [0.5, 0.99]), errors[told].max()]
    return [f"{error:.0e}" for error in told_errors]


def with_table(page: str) -> str:
    """Returns the page with the present table between its marks."""
    table = to_markdown(rows())
    print(table)
    before, _, after = page.split(MARK)
    return MARK.join([before, f"\n{table}\n", after])


def main() -> None:
    """Prints the table, and writes the page if asked to."""
    write = make_parser(__doc__, PAGE).parse_args().write
    page = with_table(PAGE.read_text(encoding="utf-8"))
    if write:
        write_page(PAGE, page, __file__)


if __name__ == "__main__":
    main()
