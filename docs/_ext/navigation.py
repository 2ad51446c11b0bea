"""Makes the navigation of the site from the lists of links on its front page.

The front page is plain Markdown: a heading, and under it a list of links. Sphinx wants
`toctree` directives, which a code host would show as text. So each such list becomes a
toctree with the heading as its caption.
"""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform


class NavigationFromLists(SphinxTransform):
    """Adds a hidden toctree to each section of the front page that lists pages."""

    default_priority = 100  # after parsing, before Sphinx collects toctrees

    def apply(self, **kwargs: Any) -> None:
        """Does so."""
        if self.env.docname != self.config.root_doc:
            return
        for section in list(self.document.findall(nodes.section)):
            pages = [
                page
                for child in section.children
                if isinstance(child, nodes.bullet_list)
                for page in _list_pages(child)
            ]
            if pages:
                section.append(self._make_toctree(section[0].astext(), pages))

    def _make_toctree(self, caption: str, pages: list[tuple[str, str]]) -> nodes.Node:
        """Returns a toctree as Sphinx's own directive makes it."""
        toctree = addnodes.toctree(
            parent=self.env.docname,
            entries=pages,
            includefiles=[page for _, page in pages],
            maxdepth=-1,
            caption=caption,
            rawcaption=caption,
            glob=False,
            hidden=True,
            includehidden=False,
            numbered=0,
            titlesonly=True,
        )
        return nodes.compound("", toctree, classes=["toctree-wrapper"])


def _list_pages(items: nodes.bullet_list) -> list[tuple[str, str]]:
    """Returns text and document of the first link of each item."""
    links = [next(iter(item.findall(addnodes.pending_xref)), None) for item in items]
    return [
        (x.astext(), x["reftarget"]) for x in links if x and x["refdomain"] == "doc"
    ]


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the transform."""
    app.add_transform(NavigationFromLists)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
