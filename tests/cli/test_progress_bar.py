"""The bar of work that takes long."""

import re
import time

from rich.console import Console

from drake_haptics.cli import console as module
from drake_haptics.cli.console import progress_bar


class WatchedProgress(module.ProgressBar):
    """A bar whose clock a test moves."""

    now_s = 0.0

    def __init__(self, *columns, console, **options):
        WatchedProgress.console = Console(width=100, record=True, force_terminal=True)
        options |= {"auto_refresh": False, "transient": False}
        options |= {"console": self.console, "get_time": lambda: WatchedProgress.now_s}
        super().__init__(*columns, **options)


def test_the_clock_goes_on_in_the_next_part_of_the_work(monkeypatch, capsys):
    monkeypatch.setenv("FORCE_COLOR", "1")  # as if stderr were a terminal
    monkeypatch.setattr(module, "ProgressBar", WatchedProgress)
    with progress_bar() as show:
        for WatchedProgress.now_s, what, share in (
            (10.0, "looking", 1.0),
            (20.0, "drawing", 0.5),
            (70.0, "drawing", 1.0),
        ):
            show(what, share)
    seen = re.findall(r"(\d:\d\d:\d\d) (\w+)", WatchedProgress.console.export_text())
    assert ("0:00:10", "looking") in seen
    assert ("0:00:20", "drawing") in seen
    assert seen[-1] == ("0:01:10", "drawing")


def test_without_a_terminal_long_work_writes_a_line_now_and_then(monkeypatch, capsys):
    clock = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: clock[-1])
    with progress_bar() as show:
        for now_s, what, share in (
            (1.0, "looking", 0.0),
            (9.0, "holding", 0.0),
            (12.0, "holding", 0.5),
            (13.0, "map of 64 points, about 40 s", 0.0),
            (14.0, "map of 64 points, about 40 s", 0.1),
            (22.9, "map of 64 points, about 40 s", 0.2),
            (23.1, "map of 64 points, about 40 s", 0.25),
        ):
            clock.append(now_s)
            show(what, share)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.splitlines() == [
        "holding: 50%",
        "map of 64 points, about 40 s: 0%",
        "map of 64 points, about 40 s: 25%",
    ]


def test_without_a_terminal_short_work_writes_nothing(capsys):
    with progress_bar() as show:
        show("looking", 0.0)
        show("drawing", 1.0)
    assert capsys.readouterr().err == ""
