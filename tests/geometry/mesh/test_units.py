"""Which unit a file is probably in."""

import pytest

from drake_haptics.geometry.mesh.units import guess_unit


@pytest.mark.parametrize(
    ("extent", "unit"),
    [
        (108.0, "mm"),  # a cup of 108 mm
        (20.0, "mm"),  # a nut
        (0.11, "m"),
        (5e-4, "km"),
        (2500.0, "mm"),  # larger than what a hand holds, yet usual
        (1e-9, None),
        (1e9, None),
    ],
)
def test_the_likeliest_unit_is_guessed(extent, unit):
    assert guess_unit(extent, 1e-3, 10.0) == unit
