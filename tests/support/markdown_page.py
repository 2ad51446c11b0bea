"""The parts of a Markdown page that a reader types, and the outputs that it shows."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

PROGRAM = "drake-haptics"


@dataclass(frozen=True)
class Block:
    """A fenced block.

    Attributes:
        language: Language behind the fence; "" where there is none.
        text: Text between the fences.
        line: Number of the opening fence's line, from 1.
    """

    language: str
    text: str
    line: int

    @property
    def commands(self) -> list[str]:
        """The commands of a shell block, without comments."""
        lines = re.sub(r"\\\n\s*", "", self.text).splitlines()
        return [x for line in lines if (x := line.split(" #")[0].strip())]


def find_blocks(text: str) -> list[Block]:
    """Returns the fenced blocks of a page in their order."""
    return [
        Block(match[1], match[2], text[: match.start()].count("\n") + 1)
        for match in re.finditer(r"(?ms)^```(\w*)\n(.*?)^```$", text)
    ]


def run_snippets(text: str) -> list[list[tuple[Any, ...]]]:
    """Runs the Python blocks of a page one after the other, as a reader would.

    Returns:
        What each block prints: the arguments of each call of `print`.
    """
    printed: list[list[tuple[Any, ...]]] = []
    names = {"print": lambda *values: printed[-1].append(values)}
    for block in find_blocks(text):
        if block.language == "python":
            printed.append([])
            exec(compile(block.text, f"line {block.line} of the page", "exec"), names)
    return printed


def find_spans(text: str) -> list[str]:
    """Returns the code spans of a page outside fenced blocks."""
    prose = re.sub(r"(?ms)^```\w*\n.*?^```$", "", text)
    return [" ".join(span.split()) for span in re.findall(r"`([^`]+)`", prose)]


def find_span_commands(text: str) -> list[str]:
    """Returns the code spans that are commands of this package."""
    return [span for span in find_spans(text) if span.startswith(f"{PROGRAM} ")]
