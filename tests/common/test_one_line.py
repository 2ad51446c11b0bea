"""Test what dataclasses with long fields say of themselves."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from drake_haptics.common.one_line import brief, count, depth, one_line


class Color(Enum):
    """A field that is one of a few."""

    RED = 1


@dataclass
class Sample:
    """Fields of every kind."""

    time_s: float
    wrench: np.ndarray
    matrix: np.ndarray
    color: Color
    inner: object = None
    _memo: int = 7
    unseen: int = field(default=8, repr=False)

    __repr__ = one_line


def test_numbers_are_told_and_large_arrays_counted() -> None:
    inner = Sample(0.0, np.zeros(2), np.zeros(1), Color.RED)
    told = repr(Sample(1 / 3, np.arange(6.0), np.eye(12), Color.RED, inner))
    assert told == (
        "Sample(time_s=0.3333, wrench=[0 1 2 3 4 5], matrix=12×12 numbers, "
        "color=RED, inner=Sample(...))"
    )


def test_collections_are_told_up_to_three_items() -> None:
    assert brief((1, "a", None)) == "(1, 'a', None)"
    assert brief([0.5] * 4) == "4 × float"
    assert brief((1, "a", 2, 3)) == "4 × items"
    assert brief({"stiffness": 1, "damping": 2}) == "{stiffness, damping}"


def test_numbers_of_numpy_look_like_those_of_python() -> None:
    assert brief(np.float64(1 / 3)) == "0.3333"
    assert brief(np.int32(4)) == "4"
    assert brief(np.bool_(True)) == "True"


def test_other_objects_are_named_by_their_class() -> None:
    assert brief(object()) == "object"


def test_one_is_no_plural() -> None:
    assert [count(n, "piece") for n in (0, 1, 2)] == ["0 pieces", "1 piece", "2 pieces"]


def test_a_depth_of_meters_is_not_told_in_millimeters() -> None:
    told = [depth(meters) for meters in (0.0, 0.0123456, 0.9, 10.971341, 12345.6)]
    assert told == ["0.000 mm", "12.346 mm", "900.000 mm", "10.971 m", "12,345.600 m"]
    assert depth(0.0123456, 2) == "12.35 mm"
