"""Marks wide tables, and cells that hold sentences, so that all can be read.

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
_MANY = "many-columns"
_MOST_COLUMNS = 6  # of a table whose letters are as large as the text's
_UPRIGHT = "upright-heads"
_MOST_LEVEL = 12  # columns whose heads are level


class WordyCells(SphinxTransform):
    """Gives classes to cells of more than a few words and to tables of many columns."""

    default_priority = 900

    def apply(self, **kwargs: Any) -> None:
        """Does so."""
        for cell in self.document.findall(nodes.entry):
            if len(cell.astext()) > _LONGEST_SHORT:
                cell["classes"].append(_CLASS)
        for table in self.document.findall(nodes.tgroup):
            if table["cols"] > _MOST_COLUMNS:
                table.parent["classes"].append(_MANY)
            if table["cols"] > _MOST_LEVEL:
                table.parent["classes"].append(_UPRIGHT)


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the transform."""
    app.add_transform(WordyCells)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
