"""Lets links to files and folders of the repository lead somewhere on the site.

On a code host `[the test](../tests/geometry/mesh/test_mesh.py)` shows the file. The
site has a page for each file that is linked (see `repository_pages`), and one for each
folder. So no page needs to know where the repository is hosted.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.transforms import SphinxTransform

_FRONT_PAGE = "index"  # where links to folders of pages lead
_REFERENCE_TYPE = "repository"
METADATA = "repository_links"  # key of a page's metadata: the paths that it links to


class RepositoryLinks(SphinxTransform):
    """Marks the links that leave the folder of the pages."""

    default_priority = 90  # before the navigation is made of links

    def apply(self, **kwargs: Any) -> None:
        """Does so."""
        docs = Path(self.env.srcdir)
        folder = Path(self.env.doc2path(self.env.docname)).parent
        for kind in (addnodes.pending_xref, addnodes.download_reference):
            for link in list(self.document.findall(kind)):
                target = link["reftarget"].partition("#")[0]
                path = folder / target
                if link.get("refdomain") == "doc":  # MyST took the suffix away
                    path = path.with_suffix(".md")
                path = path.resolve()
                if path.is_relative_to(docs):
                    if target and path.is_dir():  # as of the tutorials
                        link.attributes.update(
                            refdomain="doc", reftarget=_FRONT_PAGE, reftargetid=None
                        )
                elif path.exists():
                    self._mark(link, path.relative_to(docs.parent).as_posix())

    def _mark(self, link: nodes.Element, name: str) -> None:
        """Makes a link one to a path of the repository."""
        self.env.metadata[self.env.docname].setdefault(METADATA, set()).add(name)
        marked = addnodes.pending_xref(
            "", *link.children, reftype=_REFERENCE_TYPE, reftarget=name
        )
        marked["refdomain"] = ""
        marked["refdoc"] = self.env.docname
        link.replace_self(marked)


def page_of(name: str) -> str:
    """Returns the page of a path of the repository."""
    return f"repository/{name}"


def _resolve(
    app: Sphinx, env: BuildEnvironment, node: addnodes.pending_xref, content: nodes.Node
) -> nodes.reference | None:
    """Returns the link to the page of a path, for Sphinx's `missing-reference`."""
    if node["reftype"] != _REFERENCE_TYPE:
        return None
    uri = app.builder.get_relative_uri(node["refdoc"], page_of(node["reftarget"]))
    return nodes.reference("", "", content, refuri=uri, internal=True)


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the links."""
    app.add_transform(RepositoryLinks)
    app.connect("missing-reference", _resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
