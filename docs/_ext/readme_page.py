"""Shows the README as the page `start`, which on a code host only links to it."""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

_PAGE = "start"
# Targets of links and pictures, in Markdown and in HTML, that are paths.
_PATH = re.compile(r"""(\]\(|(?:src|srcset|href)=")(?![a-z]+:|\#)([^)"\s]+)""")


def read_readme(docs: Path) -> str:
    """Returns the README with its paths as seen from the folder of the pages."""
    text = (docs.parent / "README.md").read_text(encoding="utf-8")
    return _PATH.sub(lambda m: m[1] + posixpath.relpath(m[2], docs.name), text)


def _replace(app: Sphinx, page: str, source: list[str]) -> None:
    if page == _PAGE:
        app.env.note_dependency(str(app.srcdir.parent / "README.md"))
        source[0] = read_readme(app.srcdir)


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the page."""
    app.connect("source-read", _replace)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
