"""Pages of the modules of the package, a page for each group of them.

What `drake_haptics` offers by name is described in `reference/api.md`, and each system
on a page of its own; here is the rest.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Iterable
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from docutils import nodes
from generated_folder import FOLDER, make_heading, write_pages
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from system_pages import list_system_modules

import drake_haptics

_PACKAGE = "drake_haptics."
_PREFIX = "modules-"
# What is behind one command alone is no interface, and the command line has a page.
_PROGRAMS = ["cli", "cockpit", "evaluation", "web"]
LEFT_OUT = ""
# A module is in the first group that has a pattern for it, without the package.
_GROUPS = {
    "Scenes": ["scene", "scene.*", "authoring", "authoring.*"],
    "Geometry": ["geometry", "geometry.*"],
    "Parts of the systems": ["systems", "systems.*"],
    "Devices": ["device", "device.*", "web.mouse_device"],
    "Recorded runs": ["tick_log", "tick_log.*", "visualization.meshcat"],
    "Stability": ["analysis", "analysis.*", "bounds", "bounds.*"],
    "The compiled core": ["_core"],
    LEFT_OUT: [*_PROGRAMS, *(f"{name}.*" for name in _PROGRAMS)],
    "Building and running": ["*"],
}


def list_modules() -> list[str]:
    """Returns the modules of the package, without its name."""
    # Not `__path__`: that of an editable installation has the repository in it as well.
    folder = Path(drake_haptics.__file__).parent
    found = pkgutil.walk_packages([str(folder)], _PACKAGE)
    return ["_core", *sorted(m.name.removeprefix(_PACKAGE) for m in found)]


def group_modules(modules: Iterable[str]) -> dict[str, list[str]]:
    """Returns modules by group; those of the group LEFT_OUT are not described."""
    groups: dict[str, list[str]] = {name: [] for name in _GROUPS}
    for module in modules:
        groups[_find_group(module)].append(module)
    return groups


def _find_group(module: str) -> str:
    return next(
        name
        for name, patterns in _GROUPS.items()
        if any(fnmatch(module, pattern) for pattern in patterns)
    )


class ModuleGroups(SphinxDirective):
    """The directive `module-groups`: a list of the pages, in order."""

    def run(self) -> list[nodes.Node]:
        """Returns it as a toctree."""
        groups = [group for group in _GROUPS if group != LEFT_OUT]
        pages = [f"{FOLDER}/{_PREFIX}{_name_page(group)}" for group in groups]
        toctree = addnodes.toctree(
            parent=self.env.docname,
            entries=[(None, page) for page in pages],
            includefiles=pages,
            maxdepth=2,
            glob=False,
            hidden=False,
            titlesonly=False,
        )
        return [nodes.compound("", toctree, classes=["toctree-wrapper"])]


def _name_page(group: str) -> str:
    return group.lower().replace(" ", "-")


def _write(app: Sphinx) -> None:
    described = list_system_modules(app.srcdir)
    modules = [module for module in list_modules() if module not in described]
    pages = {
        _name_page(name): make_heading(name, "=") + "".join(map(_describe, group))
        for name, group in group_modules(modules).items()
        if name != LEFT_OUT
    }
    write_pages(app.srcdir, _PREFIX, pages)


def _describe(module: str) -> str:
    name = f"{_PACKAGE}{module}"
    return make_heading(name, "-") + (
        f".. automodule:: {name}\n   :ignore-module-all:\n\n"
    )


def _skip(
    app: Sphinx, what: str, name: str, thing: Any, skip: bool, options: Any
) -> bool | None:
    """Leaves out of a module what the package offers by name."""
    page = app.env.docname.rpartition("/")[2]
    if what != "module" or not page.startswith(_PREFIX):
        return None
    is_public = name in drake_haptics.__all__ and getattr(drake_haptics, name) is thing
    return True if is_public else None


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the pages."""
    app.add_directive("module-groups", ModuleGroups)
    app.connect("builder-inited", _write)
    app.connect("autodoc-skip-member", _skip)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
