"""A page for each module of systems, and the directive that lists them.

In a page, ::

    ```{systems}
    systems.virtual_coupling
    ```

is a table of the systems in these modules of `drake_haptics`, each with the first line
of its docstring, and puts their pages into the navigation.
"""

from __future__ import annotations

import inspect
import re
from importlib import import_module
from pathlib import Path
from typing import Any

from docutils import nodes
from generated_folder import FOLDER, make_heading, write_pages
from pydrake.systems.framework import System
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

_PREFIX = "system-"
_DIRECTIVE = re.compile(r"```\{systems\}\n(.*?)```", re.DOTALL)
LIST = "reference/systems.md"


def list_system_modules(docs: Path) -> list[str]:
    """Returns the modules that the page of all systems lists, without the package."""
    text = (docs / LIST).read_text(encoding="utf-8")
    return [name for block in _DIRECTIVE.findall(text) for name in block.split()]


def find_systems(module_name: str) -> dict[str, type[System]]:
    """Returns the public systems that a module defines."""
    module = import_module(f"drake_haptics.{module_name}")
    return {
        name: value
        for name, value in vars(module).items()
        if not name.startswith("_")
        and "𝓣" not in name  # an instance of a template has a plain name too
        and inspect.isclass(value)
        and issubclass(value, System)
        and value.__module__ == module.__name__
    }


class SystemList(SphinxDirective):
    """The directive `systems`."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Returns the table, and the part of the navigation."""
        modules = [name for line in self.content for name in line.split()]
        rows: list[nodes.Node] = []
        for module in modules:
            for name, system in find_systems(module).items():
                summary, _ = self.parse_inline(
                    (inspect.getdoc(system) or "").split("\n")[0]
                )
                rows += [
                    nodes.term("", "", _make_link(self.env.docname, module, name)),
                    nodes.definition("", nodes.paragraph("", "", *summary)),
                ]
        items = [
            nodes.definition_list_item("", *pair)
            for pair in zip(rows[::2], rows[1::2], strict=True)
        ]
        toctree = addnodes.toctree(
            parent=self.env.docname,
            entries=[(None, _page_of(module)) for module in modules],
            includefiles=[_page_of(module) for module in modules],
            maxdepth=1,
            glob=False,
            hidden=True,
            titlesonly=True,
        )
        table = nodes.definition_list("", *items, classes=["simple"])
        return [table, nodes.compound("", toctree, classes=["toctree-wrapper"])]


def _make_link(page: str, module: str, name: str) -> nodes.Node:
    """Returns a link to where a system is described."""
    return addnodes.pending_xref(
        "",
        nodes.literal("", name),
        refdomain="py",
        refdoc=page,
        reftype="class",
        reftarget=f"drake_haptics.{module}.{name}",
    )


def _page_of(module: str) -> str:
    return f"{FOLDER}/{_PREFIX}{module.rpartition('.')[2]}"


def _write(app: Sphinx) -> None:
    modules = list_system_modules(app.srcdir)
    pages = {name.rpartition(".")[2]: _make_page(name) for name in modules}
    write_pages(app.srcdir, _PREFIX, pages)


def _make_page(module_name: str) -> str:
    """Returns a page on which the systems of a module come before what they need."""
    systems = find_systems(module_name)
    module = import_module(f"drake_haptics.{module_name}")
    others = [
        (name, "autofunction" if inspect.isfunction(value) else "autoclass")
        for name, value in vars(module).items()
        if not name.startswith("_")
        and "𝓣" not in name
        and name not in systems
        and (inspect.isfunction(value) or inspect.isclass(value))
        and value.__module__ == module.__name__
    ]
    text = make_heading(", ".join(systems), "=")
    text += f".. automodule:: {module.__name__}\n   :no-members:\n\n"
    text += f".. currentmodule:: {module.__name__}\n\n"
    for name in systems:
        text += f".. autoclass:: {name}\n   :show-inheritance:\n\n"
    return text + "".join(f".. {directive}:: {name}\n\n" for name, directive in others)


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the pages and the directive."""
    app.add_directive("systems", SystemList)
    app.connect("builder-inited", _write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
