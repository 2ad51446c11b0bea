"""What to say of a file that is not there."""

from __future__ import annotations

import difflib
import os
from pathlib import Path


def describe_missing(path: str | os.PathLike[str]) -> str:
    """Returns where a file was looked for, and which one may have been meant."""
    path = Path(path)
    where = "" if path.is_absolute() else f"; looked in {Path.cwd() / path.parent}"
    words = f"{path}: no such file{where}"
    if not path.parent.is_dir():
        return f"{path}: no such file: there is no folder {path.parent}"
    try:
        names = [item.name for item in path.parent.iterdir()]
    except OSError:  # A folder that may be entered, but not listed.
        return words
    near = difflib.get_close_matches(path.name, names, n=1)
    return f"{words}; did you mean '{near[0]}'?" if near else words
