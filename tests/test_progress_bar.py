"""The bar of work that takes long."""

import re

from rich.console import Console

from drake_haptics.cli import progress_bar as module
from drake_haptics.cli.progress_bar import progress_bar


class WatchedProgress(module.Progress):
    """A bar whose clock a test moves."""

    now_s = 0.0

    def __init__(self, *columns, console, **options):
        WatchedProgress.console = Console(width=100, record=True, force_terminal=True)
        options |= {"disable": False, "auto_refresh": False, "transient": False}
        options |= {"console": self.console, "get_time": lambda: WatchedProgress.now_s}
        super().__init__(*columns, **options)


def test_the_clock_goes_on_in_the_next_part_of_the_work(monkeypatch, capsys):
    monkeypatch.setattr(module, "Progress", WatchedProgress)
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
