"""What `--help` teaches besides options: examples, exit codes, what to try next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import click


@dataclass(frozen=True)
class Lesson:
    """What stands below the options.

    Attributes:
        examples: What is to be seen, and the words of a command line that shows it.
        exits: What the exit code tells, in a sentence.
        further: What to try next.
    """

    examples: Sequence[tuple[str, str]]
    exits: str = ""
    further: str = ""

    def format(self, formatter: click.HelpFormatter) -> None:
        """Writes the sections."""
        with formatter.section("Examples"):
            for what, words in self.examples:
                formatter.write_text(f"{what}:")
                # Not wrapped: it is to be copied.
                formatter.write(f"{'':{formatter.current_indent + 2}}{words}\n")
        for title, text in [("Exit code", self.exits), ("Next", self.further)]:
            if text:
                with formatter.section(title):
                    formatter.write_text(text)


class TaughtCommand(click.Command):
    """A command whose `--help` ends with a lesson.

    Args:
        lesson: The lesson.
    """

    def __init__(self, *args: Any, lesson: Lesson, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.lesson = lesson

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Writes the lesson."""
        self.lesson.format(formatter)
