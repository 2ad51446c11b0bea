"""Pages with figures, each with a line that says at which commit these were made."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Mapping
from pathlib import Path

from page_parts import replace_part

ROOT = Path(__file__).parents[2]
# What figures depend on: pages change while figures are written into them.
_SOURCES = (
    "drake_haptics",
    "systems",
    "models",
    "tests",
    "docs/generate",
    "pyproject.toml",
)
_LINE = "Figures of `{}`: made at commit {}."
STAMP = re.compile(
    r"Figures of `(?P<generator>docs/generate/\w+\.py)`: made at commit"
    r" `(?P<commit>[0-9a-f]{7,})` of (?P<date>\d{4}-\d\d-\d\d)(?:, with changes)?"
    # Some of them later.
    r"(?:; [^;`]+ at commit `[0-9a-f]{7,}` of \d{4}-\d\d-\d\d(?:, with changes)?)*\."
)


def describe_commit() -> str:
    """Returns hash and date of the commit, and whether sources have changed since."""
    commit = _git("log", "-1", "--abbrev=8", "--format=`%h` of %cs")
    changed = _git("status", "--porcelain", "--untracked-files=no", "--", *_SOURCES)
    return f"{commit}, with changes" if changed else commit


def make_stamp(generator: str | Path, commit: str) -> str:
    """Returns the line, without a line break.

    Args:
        generator: The program that makes the figures, in the repository.
        commit: Text of `describe_commit`.
    """
    return _LINE.format(Path(generator).resolve().relative_to(ROOT).as_posix(), commit)


def with_stamp(text: str, stamp: str) -> str:
    """Returns a page that ends with that line, after those of other programs."""
    name = stamp.partition(":")[0]
    lines = [x for x in text.rstrip().split("\n") if not x.startswith(f"{name}:")]
    follows = bool(lines) and STAMP.fullmatch(lines[-1])
    page = "\n".join(lines).rstrip()
    return f"{page}\n{'' if follows else chr(10)}{stamp}\n"


def write_page(page: Path, text: str, generator: str | Path) -> None:
    """Writes a page with figures, and the time when they were made.

    Args:
        page: The file.
        text: Its text.
        generator: The program that made the figures, in the repository.
    """
    stamp = make_stamp(generator, describe_commit())
    page.write_text(with_stamp(text, stamp), encoding="utf-8")


def write_parts(page: Path, parts: Mapping[str, str], generator: str | Path) -> None:
    """Writes a page with new parts by name, and the time when they were made."""
    text = page.read_text(encoding="utf-8")
    for name, part in parts.items():
        text = replace_part(text, part, name)
    write_page(page, text, generator)


def show_parts(
    page: Path, parts: Mapping[str, str], generator: str | Path, write: bool
) -> None:
    """Prints parts of a page, and writes them into it if asked to."""
    print("\n".join(parts.values()))
    if write:
        write_parts(page, parts, generator)


def amend_page(page: Path, text: str, generator: str | Path, what: str) -> None:
    """Writes a page with some figures made again, and says which and when.

    Args:
        page: The file.
        text: Its text.
        generator: The program that made the figures, in the repository.
        what: The figures that it made now.
    """
    stamp = make_stamp(generator, describe_commit())
    page.write_text(with_amendment(text, stamp, what), encoding="utf-8")


def with_amendment(text: str, stamp: str, what: str) -> str:
    """Returns a page whose stamp says which figures were made again at another commit.

    Args:
        text: Text of the page, with a stamp of the same program.
        stamp: Line as it would be for all figures.
        what: Name of the figures that are meant, once.
    """
    name, _, now = stamp.partition(": made ")
    [old] = [x for x in text.rstrip().split("\n") if x.startswith(f"{name}:")]
    kept = [x for x in old.rstrip(".").split("; ") if not x.startswith(f"{what} at ")]
    return with_stamp(text, "; ".join([*kept, f"{what} {now}"]))


def _git(*arguments: str) -> str:
    command = ["git", "-C", str(ROOT), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout[
        :-1
    ]
