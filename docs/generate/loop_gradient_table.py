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
from page_stamp import show_parts

PAGE = Path(__file__).parents[2] / "docs" / "gradients.md"
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
TITLES = ("scene", "columns compared", "at a kink", "update", "rates")


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
            f"{columns - kinks}",
            f"{kinks}",
            _tell_error(found, slice(None, found[0].num_updated)),
            _tell_error(found, slice(found[0].num_updated, None)),
        )


def _tell_error(found: list[LoopGradients], part: slice) -> str:
    """Returns the largest error of some rows, in all states."""
    errors, expected = (
        np.concatenate([values(gradients)[part].ravel() for gradients in found])
        for values in (lambda g: g.errors, lambda g: g.expected)
    )
    return f"{errors[~np.isnan(expected)].max():.0e}"


def main() -> None:
    """Prints the table, and writes the page if asked to."""
    write = make_parser(__doc__, PAGE).parse_args().write
    table = to_markdown(rows())
    show_parts(PAGE, {"loops": table}, __file__, write)


if __name__ == "__main__":
    main()
