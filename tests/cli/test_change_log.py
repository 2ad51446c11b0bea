"""What a driver notes where nobody watches: each change once, with its time."""

import io

from rich.console import Console

from drake_haptics.cli.live_line import ChangeLog


def note(states, *, terminal):
    """Returns what is written of states, one for each second."""
    out, times = io.StringIO(), iter(range(len(states) + 1))
    left = iter(states)
    console = Console(file=out, force_terminal=terminal, width=60)
    log = ChangeLog(console, lambda: next(left), clock=lambda: float(next(times)))
    with log:
        for _ in states:
            log.update()
    return out.getvalue()


def test_each_change_is_a_line_with_its_time():
    # The clock is read for lines alone.
    text = note(["IDLE", "IDLE", "[red]FAULT (stale)[/]", "IDLE"], terminal=False)
    assert [line.split() for line in text.splitlines()] == [
        ["1.0", "s", "IDLE"],
        ["2.0", "s", "FAULT", "(stale)"],
        ["3.0", "s", "IDLE"],
    ]


def test_a_long_change_is_not_broken():
    words = "WAITING: lead the handle to where the tool can follow; Enter shows it now"
    assert note([words], terminal=False) == f"     1.0 s  {words}\n"


def test_a_terminal_has_its_line_that_changes():
    assert note(["IDLE", "ACTIVE"], terminal=True) == ""


def test_a_reader_that_has_gone_does_not_stop_the_loop():
    class Gone(io.StringIO):
        def write(self, _):
            raise BrokenPipeError

    states = iter(["IDLE", "ACTIVE"])
    log = ChangeLog(Console(file=Gone(), width=60), lambda: next(states))
    with log:
        log.update()
        log.update()
