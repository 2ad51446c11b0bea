"""Counts instructions: a tick takes no more than it did, nor for what is not named.

Instructions are the same on a busy machine and on an idle one; times are not.
"""

from __future__ import annotations

import shutil

import effect_instructions
import pytest
from tick_instructions import measure

pytestmark = pytest.mark.skipif(
    shutil.which("valgrind") is None,
    reason="instructions of a tick are counted with valgrind, which is not installed",
)
# Of the core and of the whole, of cup_spoon in contact, counted when this was written:
# GCC 12, CPython 3.11. `python tests/benchmarks/tick_instructions.py` counts again; a
# change that needs more on purpose says so here.
COUNTS = {"backend": (62_500, 288_400), "plant": (57_600, 347_500)}


def test_a_tick_of_the_cup_takes_no_more_instructions_than_it_did():
    for loop, found in measure("cup_spoon", [*COUNTS]).items():
        core, whole = COUNTS[loop]
        assert 0.5 * core < found["core and its binding"] < 1.1 * core, loop
        # Python's and NumPy's own share is another one in each of their releases.
        assert found["core and its binding"] < sum(found.values()) < 1.25 * whole, loop


def test_an_effect_that_a_scene_does_not_name_costs_nothing():
    """Nor does one that another loop of the process has; counts scatter by 0.2 %."""
    plain, friction, after = effect_instructions.measure().values()
    assert after == pytest.approx(plain, rel=0.01)
    assert friction > 1.1 * plain
