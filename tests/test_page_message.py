"""A page may say four things, exactly."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_haptics.device.page_message import (
    PageMessage,
    PageVerb,
    read_page_message,
)


def test_it_may_say_this():
    for text, verb in [
        ('{"do": "home"}', PageVerb.HOME),
        ('{"do": "take"}', PageVerb.TAKE),
    ]:
        assert read_page_message(text) == PageMessage(verb)
    text = '{"by": [0.5, -1, 1e-3], "do": "move"}'
    assert read_page_message(text) == PageMessage(PageVerb.MOVE, (0.5, -1.0, 1e-3))
    text = '{"do":"turn","by":[0,0,0]}'
    assert read_page_message(text) == PageMessage(PageVerb.TURN)


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
        "[" * 100000,
        b'{"do": "home"}',
    ],
    ids=lambda text: repr(text[:40]),
)
def test_it_may_say_nothing_else(text):
    assert read_page_message(text) is None


_VALUES = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(),
    lambda inner: (
        st.lists(inner) | st.dictionaries(st.sampled_from(["do", "by", "x"]), inner)
    ),
)


@given(st.text() | st.binary() | _VALUES.map(json.dumps))
def test_whatever_it_says_is_understood_or_refused(text):
    message = read_page_message(text)
    assert message is None or all(abs(x) <= 1.0 for x in message.by)
