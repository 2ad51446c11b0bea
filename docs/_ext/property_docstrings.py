"""Reads docstrings of properties as those of functions.

Napoleon takes what stands before the first colon of a property's docstring for its
type, and does not look for sections like `Raises:` in it.
"""

from __future__ import annotations

from typing import Any

from sphinx.application import Sphinx
from sphinx.ext.napoleon import GoogleDocstring

_KINDS = ("attribute", "data", "property")
_NOTHING = "\\ "  # what reStructuredText shows as nothing at all
_BEFORE_NAPOLEON = 400  # whose own listener has Sphinx's default, 500


def _read(
    app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]
) -> None:
    if what in _KINDS and lines:
        read = GoogleDocstring(lines, app.config, app, "method", name, thing, options)
        lines[:] = [_NOTHING, *read.lines()]  # Napoleon looks at the first line only


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the reading."""
    app.connect("autodoc-process-docstring", _read, priority=_BEFORE_NAPOLEON)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
