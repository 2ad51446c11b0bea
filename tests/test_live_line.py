"""The line at the foot of the terminal."""

import io

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
    return text.getvalue(), asked


def test_it_is_written_five_times_per_second_and_told_the_time_between():
    text, asked = show([0.0, 0.125, 0.25, 0.375, 0.5], terminal=True)
    assert asked == [0.25, 0.25]
    assert "line 1" in text and "line 2" in text


def test_a_file_gets_nothing():
    assert show([0.0, 1.0, 2.0], terminal=False) == ("", [])
