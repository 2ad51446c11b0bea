"""Ctrl-C, SIGTERM, a closed terminal and Ctrl-Z ask, and do not tear."""

import os
import signal

import pytest

from drake_haptics.device.stop_signals import stop_on_signals


@pytest.mark.parametrize(
    "number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP]
)
def test_a_signal_asks_to_stop_and_raises_nothing(number):
    asked = []
    before = signal.getsignal(number)
    with stop_on_signals(lambda: asked.append(number)):
        os.kill(os.getpid(), number)
        assert asked == [number]
        os.kill(os.getpid(), number)
    assert asked == [number, number]
    assert signal.getsignal(number) == before


def test_signals_are_as_before_after_an_error():
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(ZeroDivisionError), stop_on_signals(lambda: None):
        raise ZeroDivisionError
    assert signal.getsignal(signal.SIGINT) == before


def test_what_outlives_its_terminal_is_not_stopped_with_it():
    """As `nohup` has it."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        asked = []
        with stop_on_signals(lambda: asked.append(signal.SIGHUP)):
            os.kill(os.getpid(), signal.SIGHUP)
        assert not asked
    finally:
        signal.signal(signal.SIGHUP, before)
