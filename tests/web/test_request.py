"""A page may say these things, exactly."""

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_haptics.web.messages import read_page_request


@pytest.mark.parametrize(
    "asked",
    [
        {"do": "move", "by": [0.5, -1, 1e-3]},
        {"do": "turn", "by": [0, 0, 0]},
        {"do": "home"},
        {"do": "take"},
        {"do": "seen", "number": 3},
        {"do": "set", "key": "contact.tolerance_m", "to": 1e-3},
        {"do": "set", "key": "contact.tolerance_m", "to": 1e-3, "number": 3},
        {"do": "choose", "key": "contact.clustering", "to": "octree"},
        {"do": "effect", "name": "friction", "on": True},
        {"do": "effect", "name": "friction", "on": True, "number": 3},
        {"do": "handle", "to": "mouse"},
        {"do": "view", "name": "pieces", "on": False},
        {"do": "camera", "to": "fit"},
        {"do": "camera", "to": "fit", "within": 0.62},
        {"do": "reset"},
        {"do": "restart"},
    ],
    ids=lambda asked: "-".join(sorted(asked.keys() | {asked["do"]})),
)
def test_it_may_say_this(asked):
    assert read_page_request(json.dumps(asked)) == asked


@pytest.mark.parametrize(
    "text",
    [
        "",
        "home",
        "[]",
        "null",
        "{}",
        '{"do": "jump"}',
        '{"do": null}',
        '{"do": ["home"]}',
        '{"do": "home", "by": [0, 0, 0]}',
        '{"do": "take", "more": 1}',
        '{"do": "move"}',
        '{"do": "move", "by": 1}',
        '{"do": "move", "by": "abc"}',
        '{"do": "move", "by": [0, 0]}',
        '{"do": "move", "by": [0, 0, 0, 0]}',
        '{"do": "move", "by": [0, 0, NaN]}',
        '{"do": "move", "by": [0, 0, Infinity]}',
        '{"do": "move", "by": [0, 0, -Infinity]}',
        '{"do": "move", "by": [0, 0, 1.001]}',
        '{"do": "move", "by": [0, 0, 1e999]}',
        f'{{"do": "move", "by": [0, 0, {10**200}]}}',
        f'{{"do": "move", "by": [0, 0, {"9" * 5000}]}}',
        f'{{"do": "move", "by": [0, 0, {10**400}]}}',
        '{"do": "move", "by": [0, 0, true]}',
        '{"do": "move", "by": [0, 0, "0"]}',
        '{"do": "move", "by": [0, 0, null]}',
        '{"do": "move", "by": [0, 0, [0]]}',
        '{"do": "move", "by": [0, 0, 0], "more": 1}',
        '{"do": "set", "key": "k"}',
        '{"do": "set", "key": "k", "to": NaN}',
        '{"do": "set", "key": "k", "to": -Infinity}',
        '{"do": "set", "key": "k", "to": 1e308}',
        '{"do": "set", "key": "k", "to": true}',
        '{"do": "set", "key": "k", "to": "1"}',
        '{"do": "set", "key": ["k"], "to": 1}',
        f'{{"do": "set", "key": "{"k" * 65}", "to": 1}}',
        '{"do": "choose", "key": "k", "to": 1}',
        '{"do": "effect", "name": "friction", "on": 1}',
        '{"do": "effect", "name": {"a": {"b": []}}, "on": true}',
        '{"do": "camera", "within": 1}',
        '{"do": "camera", "to": "fit", "within": "1"}',
        '{"do": "restart", "to": "mouse"}',
        "[" * 100000,
        b'{"do": "home"}',
    ],
    ids=lambda text: repr(text[:40]),
)
def test_it_may_say_nothing_else(text):
    assert read_page_request(text) is None


_NAMES = ["do", "by", "key", "to", "name", "on", "within"]
_VERBS = ["move", "turn", "home", "set", "choose", "effect", "camera", "restart"]
_VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.floats()
    | st.integers()
    | st.text()
    | st.sampled_from(_VERBS),
    lambda inner: (
        st.lists(inner, min_size=3, max_size=3)
        | st.dictionaries(st.sampled_from(_NAMES), inner)
    ),
)


def numbers_of(value):
    """All numbers in what was said."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        return [number for item in value for number in numbers_of(item)]
    return [value] if isinstance(value, int | float) else []


@given(st.text() | st.binary() | _VALUES.map(json.dumps))
def test_whatever_it_says_is_understood_or_refused(text):
    asked = read_page_request(text)
    assert asked is None or all(map(math.isfinite, numbers_of(asked)))
