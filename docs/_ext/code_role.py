"""Where names in docstrings lead.

`VirtualCoupling` in single backticks leads to that class, wherever it is documented, if
there is just one of that name; `octree` and `contact.tolerance_m` are shown as code. A
type in a signature is found also where the package offers it under a shorter name.
"""

from __future__ import annotations

from collections import defaultdict
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.docutils import SphinxRole

_REFERENCE_TYPE = "code"
_PACKAGE = "drake_haptics."


class CodeRole(SphinxRole):
    """The role of text in single backticks."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Returns a reference that is resolved once all pages have been read."""
        reference = addnodes.pending_xref(
            "",
            nodes.literal("", self.text),
            refdomain="",
            refdoc=self.env.docname,
            reftype=_REFERENCE_TYPE,
            reftarget=self.text.removesuffix("()"),
        )
        return [reference], []


class NameIndex:
    """All that is documented of Python, by every end of its dotted name."""

    def __init__(self) -> None:
        self._count = 0
        self._places: dict[str, set[tuple[str, str]]] = {}

    def find(self, env: BuildEnvironment, name: str) -> set[tuple[str, str]]:
        """Returns page and anchor of everything of that name."""
        objects = env.domains.python_domain.objects
        if len(objects) != self._count:
            self._count = len(objects)
            self._places = defaultdict(set)
            for full_name, thing in objects.items():
                parts = full_name.split(".")
                for i in range(len(parts)):
                    place = (thing.docname, thing.node_id)
                    self._places[".".join(parts[i:])].add(place)
        places = self._places.get(name, set())
        if not places and name.startswith(_PACKAGE):
            places = self._places.get(name.rpartition(".")[2], set())
        return places

    def resolve(
        self,
        app: Sphinx,
        env: BuildEnvironment,
        node: addnodes.pending_xref,
        content: nodes.Node,
    ) -> nodes.Node | None:
        """Returns what is shown for a reference, for Sphinx's `missing-reference`."""
        is_code = node["reftype"] == _REFERENCE_TYPE
        if not is_code and node["refdomain"] != "py":
            return None
        places = self.find(env, node["reftarget"])
        if len(places) != 1:
            return content if is_code else None
        page, anchor = next(iter(places))
        uri = app.builder.get_relative_uri(node["refdoc"], page)
        return nodes.reference("", "", content, refuri=f"{uri}#{anchor}", internal=True)


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the role."""
    app.add_role("code-or-link", CodeRole())
    app.connect("missing-reference", NameIndex().resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
