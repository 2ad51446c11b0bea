"""Ctrl-C and SIGTERM ask, and do not tear."""

import os
import signal

import pytest

from drake_haptics.device.stop_signals import stop_on_signals


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
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
