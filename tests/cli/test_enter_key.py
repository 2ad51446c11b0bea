"""The Enter key, at a real terminal and at none."""

import io
import os
import pty

import pytest

from drake_haptics.cli.enter_key import is_enter_pressed


@pytest.fixture
def keyboard(monkeypatch):
    """What a person types at a terminal that is the standard input."""
    keys, terminal = pty.openpty()
    with os.fdopen(terminal) as stdin:
        monkeypatch.setattr("sys.stdin", stdin)
        yield keys
    os.close(keys)


def test_it_is_pressed_once(keyboard):
    assert not is_enter_pressed()
    os.write(keyboard, b"\n")
    assert is_enter_pressed()
    assert not is_enter_pressed()


def test_pressed_many_times_is_pressed_once(keyboard):
    os.write(keyboard, b"\n\nabc\n")
    assert is_enter_pressed()
    assert not is_enter_pressed()


def test_other_keys_are_not_enter(keyboard):
    os.write(keyboard, b"abc")
    assert not is_enter_pressed()


@pytest.mark.parametrize("stdin", [None, io.StringIO("\n")])
def test_without_a_terminal_nobody_types(monkeypatch, stdin):
    monkeypatch.setattr("sys.stdin", stdin)
    assert not is_enter_pressed()
