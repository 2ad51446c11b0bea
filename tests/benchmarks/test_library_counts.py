"""Instructions by library: the parts are the whole, and each is where the work is."""

import shutil

import pytest
from library_counts import count_by_library

from drake_haptics.evaluation.measuring.valgrind import count_instructions

pytestmark = pytest.mark.skipif(shutil.which("valgrind") is None, reason="no valgrind")
_TIMES, _SIZE = 5000, 60 * 60
_PROGRAM = f"""
import numpy as np
from drake_haptics.evaluation.measuring.valgrind import counted
a = np.ones({_SIZE})
with counted():
    for _ in range({_TIMES}):
        np.add(a, a)
"""


def test_the_libraries_add_up_and_the_work_is_where_it_is_done():
    program = ["-c", _PROGRAM]
    found = count_by_library(program)
    assert sum(found.values()) == pytest.approx(count_instructions(program), rel=0.03)
    numpy = sum(count for path, count in found.items() if "numpy" in path)
    # Up to eight numbers at a time.
    assert _TIMES * _SIZE / 8 < numpy < _TIMES * _SIZE * 4
    assert numpy > 0.5 * sum(found.values())
