"""Values out of range are refused by name, in numbers and in arrays."""

import math
from functools import partial

import numpy as np
import pytest

from drake_haptics.common.value_checks import check_at_least, check_positive


def test_values_in_range_pass():
    check_positive(a=1e-300, b=2, c=np.ones(3))
    check_at_least(0, a=0.0, b=[0, 1e300])


@pytest.mark.parametrize("value", [0, -1e-9, math.inf, math.nan, [1.0, 0.0]])
def test_what_is_not_positive_is_refused(value):
    with pytest.raises(ValueError, match=r"^b must be positive and finite, is "):
        check_positive(a=1.0, b=value)


@pytest.mark.parametrize("value", [1, 1.999, math.inf, math.nan, [3.0, -math.inf]])
def test_what_is_below_the_least_is_refused(value):
    with pytest.raises(ValueError, match=r"^b must be at least 2 and finite, is "):
        check_at_least(2, a=2, b=value)


@pytest.mark.parametrize("value", ["1", None, ["1"], 1j])
def test_what_is_no_number_is_refused_by_name(value):
    for check in (check_positive, partial(check_at_least, 0)):
        with pytest.raises(TypeError, match=r"^b must be a number, is "):
            check(a=1.0, b=value)
