"""Ctrl-C ends a run, wherever it falls."""

import io
import os
import signal

import pytest
from fake_device import ScriptedDevice, make_reading
from rich.console import Console

from drake_haptics.cli import run_session as module
from drake_haptics.cli.lasting_interrupt import lasting_interrupt
from drake_haptics.scene import load_scene
from drake_haptics.scene_library import find_scene


def interrupt_and_swallow():
    """Ctrl-C within code that drops what is raised, as destructors do."""
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)


def test_it_is_raised_again_where_it_was_swallowed():
    before = signal.getsignal(signal.SIGINT)
    with lasting_interrupt() as check:
        check()
        interrupt_and_swallow()
        for _ in range(2):
            with pytest.raises(KeyboardInterrupt):
                check()
    assert signal.getsignal(signal.SIGINT) == before


def test_where_it_was_ignored_it_still_is():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with lasting_interrupt() as check:
            os.kill(os.getpid(), signal.SIGINT)
            check()
        assert signal.getsignal(signal.SIGINT) == signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("call", [1, 20])
def test_a_run_ends_though_its_interrupt_was_swallowed(monkeypatch, call):
    """While the scene is built, and in a tick."""

    def read(number):
        if number == call:
            interrupt_and_swallow()
        return make_reading(number)

    device = ScriptedDevice(read)
    monkeypatch.setattr(module, "open_device", lambda *_: device)
    session = module.run_session(
        Console(file=io.StringIO()),
        load_scene(find_scene("sphere_pen")),
        device="here",
        meshcat=None,
        page=None,
        prepare=lambda *_: None,
        duration_s=1.0,
        energy=False,
        explained=False,
        log=None,
    )
    assert session.figures["duration_s"] < 0.5
    assert device.closed
