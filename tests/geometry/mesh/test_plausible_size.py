"""A tolerance is asked about where it is wider than the tool, and only there."""

import pytest

from drake_haptics.geometry.mesh.checks import make_tolerance_warnings


@pytest.mark.parametrize("tolerance_m", [0.0, 1e-3, 0.02])
def test_nothing_is_asked_of_what_is_within_the_tool(tolerance_m):
    assert make_tolerance_warnings(tolerance_m, "the tool", 0.02) == []


def test_what_is_wider_is_named_with_both_lengths():
    (sentence,) = make_tolerance_warnings(2.0, "the tool", 0.02)
    assert sentence.startswith(
        "contact.tolerance_m: is 2 m, more than the tool is wide"
    )
    assert "(20 mm)" in sentence and "in meters" in sentence
