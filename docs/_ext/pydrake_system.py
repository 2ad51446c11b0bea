"""Draws the ports of a system as Drake's pages do: inputs, a box, outputs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from system_block import Port, parse_block


class PydrakeSystem(SphinxDirective):
    """The directive `pydrake_system`; its content is that of `system_block`."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Returns the box. What it looks like is in `_static/system_block.css`."""
        assert isinstance(self.content, StringList)
        try:
            block = parse_block("\n".join(self.content))
        except ValueError as error:
            raise self.error(str(error)) from error
        box = nodes.container(classes=["system-block"])
        box += _make_list("system-inputs", "inputs", block.input_ports)
        box += nodes.paragraph("", block.name, classes=["system-name"])
        box += _make_list("system-outputs", "outputs", block.output_ports)
        return [box]


def _make_list(name: str, words: str, ports: Sequence[Port]) -> nodes.Node:
    """Returns the ports of one side."""
    if not ports:
        return nodes.paragraph("", f"no {words}", classes=[name])
    return nodes.bullet_list("", *map(_make_item, ports), classes=[name])


def _make_item(port: Port) -> nodes.Node:
    text = nodes.paragraph("", "", nodes.literal("", port.name))
    if port.condition:
        text += nodes.inline("", f" {port.condition}", classes=["system-condition"])
    return nodes.list_item("", text)


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the directive."""
    app.add_directive("pydrake_system", PydrakeSystem)
    app.add_css_file("system_block.css")
    return {"parallel_read_safe": True, "parallel_write_safe": True}
