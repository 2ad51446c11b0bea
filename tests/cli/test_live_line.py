"""The line at the foot of the terminal."""

import io
import itertools
import os
import pty
import threading
import time
from contextlib import suppress
from termios import TCOOFF, TCOON, tcflow

from rich.console import Console

from drake_haptics.cli.live_line import LiveLine


def show(times, *, terminal):
    """Updates the line at each of the times; returns what was written and asked."""
    text, asked, clock = io.StringIO(), [], iter(times)
    console = Console(file=text, force_terminal=terminal, width=60, color_system=None)

    def make_line(passed_s):
        asked.append(passed_s)
        return f"line {len(asked)}"

    with LiveLine(console, make_line, clock=lambda: next(clock)) as line:
        for _ in times[1:]:
            line.update()
            while asked and f"line {len(asked)}" not in text.getvalue():
                time.sleep(1e-3)  # as a thread of its own writes it
    return text.getvalue(), asked


def test_it_is_written_five_times_per_second_and_told_the_time_between():
    text, asked = show([0.0, 0.125, 0.25, 0.375, 0.5], terminal=True)
    assert asked == [0.25, 0.25]
    assert "line 1" in text and "line 2" in text


def test_a_narrow_terminal_cuts_the_line():
    text, times = io.StringIO(), itertools.count()
    console = Console(file=text, force_terminal=True, width=20, color_system=None)
    with LiveLine(
        console,
        lambda _: "[bold]most[/] important first, then the rest",
        lambda: next(times),
    ) as line:
        line.update()
        while "most" not in text.getvalue():
            time.sleep(1e-3)
    assert "most important firs…" in text.getvalue()
    assert "rest" not in text.getvalue()


def test_a_file_gets_nothing():
    assert show([0.0, 1.0, 2.0], terminal=False) == ("", [])


def test_a_terminal_that_takes_nothing_does_not_stop_the_loop():
    """Ctrl-S, or a connection to the terminal that hangs: force must not stay on."""
    ours, terminal = pty.openpty()
    tcflow(terminal, TCOOFF)
    times = itertools.count()
    updates = []

    def loop(console):
        with LiveLine(console, lambda _: "line", clock=lambda: next(times)) as line:
            for _ in range(20):
                line.update()
                updates.append(line)

    with open(terminal, "w") as file:
        console = Console(file=file, force_terminal=True, width=60)
        thread = threading.Thread(target=loop, args=(console,), daemon=True)
        thread.start()
        try:
            thread.join(20.0)
            assert len(updates) == 20
            assert not thread.is_alive()
        finally:
            tcflow(terminal, TCOON)
            for each in threading.enumerate():
                if each is thread or each.name == "live_line":
                    each.join(20.0)
    os.close(ours)


def test_a_terminal_that_has_gone_does_not_stop_the_loop():
    ours, terminal = pty.openpty()
    times = itertools.count()
    file = open(terminal, "w")
    console = Console(file=file, force_terminal=True, width=60)
    with LiveLine(console, lambda _: "line", clock=lambda: next(times)) as line:
        os.close(ours)
        for _ in range(20):
            line.update()
            time.sleep(1e-3)
    with suppress(OSError):
        file.close()
