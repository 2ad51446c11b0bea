"""Intervals of a known signal are found, and flicker is joined."""

from itertools import pairwise

import numpy as np
import pytest

from drake_haptics.evaluation.paper.profile import Interval, find_intervals


def signal(text):
    return np.array([c == "P" for c in text])


def spell(intervals):
    return "".join("DP"[i.penetrating] * (i.stop - i.start) for i in intervals)


def test_known_intervals_are_found():
    assert find_intervals(signal("DDDPPDPPPP")) == [
        Interval(0, 3, False),
        Interval(3, 5, True),
        Interval(5, 6, False),
        Interval(6, 10, True),
    ]
    assert find_intervals(signal("PPP")) == [Interval(0, 3, True)]
    assert find_intervals(np.zeros(0)) == []


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ("DDDDDPDDDDD", "DDDDDDDDDDD"),
        ("PDDDDDDD", "DDDDDDDD"),
        ("DDDDDDP", "DDDDDDD"),
        ("DDDDPDDDPPPPP", "DDDDDDDDPPPPP"),
        ("DDDDPPDPPP", "DDDDPPPPPP"),
    ],
)
def test_intervals_that_are_too_short_are_joined_with_their_neighbors(given, told):
    assert spell(find_intervals(signal(given), shortest=3)) == told


def test_intervals_alternate_and_cover_every_tick():
    rng = np.random.default_rng(1)
    for shortest in (1, 4, 30):
        inside = rng.random(500) < 0.5
        found = find_intervals(inside, shortest)
        assert [i.start for i in found[1:]] == [i.stop for i in found[:-1]]
        assert found[0].start == 0 and found[-1].stop == 500
        kinds = [i.penetrating for i in found]
        assert all(a != b for a, b in pairwise(kinds))
        assert len(found) == 1 or min(i.stop - i.start for i in found) >= shortest
    exact = find_intervals(inside)
    for i in exact:
        assert (inside[i.start : i.stop] == i.penetrating).all()
