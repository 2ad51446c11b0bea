"""The title of a picture of two runs."""

from dataclasses import replace

import pytest
from tick_log_samples import HEADER, make_rows

from drake_haptics.tick_log.diff_plot import make_title
from drake_haptics.tick_log.tick_log import TickLog


def make_log(scene):
    return TickLog(replace(HEADER, scene=scene), make_rows(0), (), 0)


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        ("a: 1\nb: 2", "x and y: the same scene"),
        ("a: 1\nb: 3", "x and y: b: 2, 3"),
        (
            "".join(f"k{i}: 1\n" for i in range(5)),
            "x and y: scenes that differ in 7 values",
        ),
    ],
)
def test_it_says_what_the_scenes_differ_by(scene, words):
    assert make_title(make_log("a: 1\nb: 2"), make_log(scene), ("x", "y")) == words


def test_long_names_are_broken_into_lines():
    title = make_title(make_log("a: 1"), make_log("a: 1"), (80 * "x", 80 * "y"))
    assert max(map(len, title.splitlines())) <= 90
