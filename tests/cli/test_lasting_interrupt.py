"""Ctrl-C, SIGTERM and a closed terminal end a run, wherever they fall."""

import io
import os
import signal

import pytest
from fake_device import ScriptedDevice, make_reading
from rich.console import Console

from drake_haptics.cli import run_session as module
from drake_haptics.cli.endings import lasting_interrupt
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

NUMBERS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]


def interrupt_and_swallow(number=signal.SIGINT):
    """A signal within code that drops what is raised, as destructors do."""
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), number)


@pytest.mark.parametrize("number", NUMBERS)
def test_it_is_raised_again_where_it_was_swallowed(number):
    before = signal.getsignal(number)
    with lasting_interrupt() as check:
        check()
        interrupt_and_swallow(number)
        for _ in range(2):
            with pytest.raises(KeyboardInterrupt):
                check()
    assert signal.getsignal(number) == before


@pytest.mark.parametrize("number", NUMBERS)
def test_where_it_was_ignored_it_still_is(number):
    before = signal.signal(number, signal.SIG_IGN)
    try:
        with lasting_interrupt() as check:
            os.kill(os.getpid(), number)
            check()
        assert signal.getsignal(number) == signal.SIG_IGN
    finally:
        signal.signal(number, before)


def test_ten_at_once_are_one_and_one_that_insists_is_another():
    times_s = [0.0, 0.0, 0.1, 1.9, 2.1, 2.1]
    with lasting_interrupt(iter(times_s).__next__):
        interrupt_and_swallow()
        for _ in range(3):
            os.kill(os.getpid(), signal.SIGINT)
        interrupt_and_swallow()
        os.kill(os.getpid(), signal.SIGTERM)


@pytest.mark.parametrize("call", [1, 20])
def test_a_run_ends_though_its_interrupt_was_swallowed(monkeypatch, call):
    """While the scene is built, and in a tick."""

    def read(number):
        if number == call:
            interrupt_and_swallow()
        return make_reading(number)

    device = ScriptedDevice(read)
    monkeypatch.setattr(module, "open_device", lambda *_: device)
    with lasting_interrupt() as check:
        session = module.run_session(
            Console(file=io.StringIO()),
            load_scene(find_scene("sphere_pen")),
            device="here",
            meshcat=None,
            open_page=None,
            prepare=lambda *_: None,
            duration_s=1.0,
            energy=False,
            explained=False,
            log=None,
            check_interrupt=check,
        )
    assert session.figures["duration_s"] < 0.5
    assert device.closed
