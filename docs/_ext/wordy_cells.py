"""Marks the cells of tables that hold sentences, so that their columns stay readable.

A browser makes such a column as narrow as its longest word where others hold code or
figures that do not break.
"""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform

_CLASS = "wordy"  # see reference.css
_LONGEST_SHORT = 40  # characters


class WordyCells(SphinxTransform):
    """Gives the cells with more than a few words a class of their own."""

    default_priority = 900

    def apply(self, **kwargs: Any) -> None:
        """Does so."""
        for cell in self.document.findall(nodes.entry):
            if len(cell.astext()) > _LONGEST_SHORT:
                cell["classes"].append(_CLASS)


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the transform."""
    app.add_transform(WordyCells)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
