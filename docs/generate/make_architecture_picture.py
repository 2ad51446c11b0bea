"""Draws the architecture: `python docs/generate/make_architecture_picture.py`.

The sources say what imports what, docstrings what a folder is for, and CMake which
folders of the core stand on which. An arrow that others imply is left out.
tests/docs/test_architecture.py holds page and picture to the code.
"""

from __future__ import annotations

import ast
import re
import sys
import textwrap
from collections.abc import Iterable, Mapping
from functools import cache
from graphlib import TopologicalSorter
from html import escape
from pathlib import Path

import pygraphviz

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from import_graph import CORE, PACKAGE, find_imports, find_modules

ROOT = Path(__file__).parents[2]
PICTURE = ROOT / "docs" / "architecture.svg"
CORE_FOLDER = ROOT / PACKAGE / "core"
# What binds the core to Python; it is not in CMake's list of folders.
_BIND = "bind"
_PYTHON, _COMPILED, _DATA = "#e6effa", "#e4f3ea", "#f6efe0"
Links = dict[str, set[str]]


@cache
def find_python_links() -> Links:
    """Returns the folders of the package, each with those that it imports from.

    The compiled core is one of them, as `core`.
    """
    modules = find_modules(ROOT)
    links: Links = {_get_folder(name): set() for name in modules if "." in name}
    for one in find_imports(modules):
        # The package's own file offers what the folders have.
        if PACKAGE not in (one.importer, one.imported):
            a, b = _get_folder(one.importer), _get_folder(one.imported)
            links[a] |= {b} - {a}
    return links


def _get_folder(module: str) -> str:
    return "core" if module == CORE else module.split(".")[1]


def find_core_links() -> Links:
    """Returns the folders of the core, each with those that its library links to."""
    text = (CORE_FOLDER / "CMakeLists.txt").read_text(encoding="utf-8")
    links: Links = {}
    for entries in re.findall(r'core_folders\s+((?:"[a-z ]+"\s*)+)\)', text):
        for entry in re.findall(r'"([a-z ]+)"', entries):
            folder, *below = entry.split()
            links[folder] = set(below)
    [bound] = re.findall(r"target_link_libraries\(_core PRIVATE ([a-z_ ]+)\)", text)
    links[_BIND] = {library.removeprefix("haptics_") for library in bound.split()}
    return links


def drop_implied(links: Mapping[str, Iterable[str]]) -> set[tuple[str, str]]:
    """Returns the links, as pairs, that no path over other folders implies."""
    below: Links = {}
    for folder in TopologicalSorter(links).static_order():
        direct = set(links.get(folder, ()))
        below[folder] = direct.union(*(below[one] for one in direct))
    return {
        (folder, one)
        for folder, direct in links.items()
        for one in direct
        if not any(one in below[other] for other in direct)
    }


def find_edges() -> set[tuple[str, str]]:
    """Returns the arrows: names of folders, those of the core as `core/base`."""
    compiled = {(f"core/{a}", f"core/{b}") for a, b in drop_implied(find_core_links())}
    python = {
        (a, f"core/{_BIND}" if b == "core" else b)
        for a, b in drop_implied(find_python_links())
    }
    return compiled | python


def read_purpose(folder: str) -> str:
    """Returns the first sentence of the docstring of a folder of the package."""
    path = ROOT / PACKAGE / folder / "__init__.py"
    if not path.is_file():  # a system without links has it beside the package alone
        path = ROOT / folder / "__init__.py"
    docstring = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return docstring.partition("\n")[0].partition(". ")[0].rstrip(".")


def make_graph() -> pygraphviz.AGraph:
    """Returns the picture, in Graphviz's language."""
    graph = pygraphviz.AGraph(directed=True, rankdir="TB", nodesep=0.25, ranksep=0.3)
    graph.node_attr.update(
        shape="box",
        style="filled,rounded",
        fontname="Helvetica",
        fontsize=12,
        color="#667788",
        height=0.3,
    )
    graph.edge_attr.update(color="#667788", arrowsize=0.7)
    for folder in find_python_links():
        if folder != "core":
            color = _DATA if folder == "models" else _PYTHON
            label = _make_label(folder, read_purpose(folder))
            graph.add_node(folder, label=label, fillcolor=color)
    for folder in find_core_links():
        name = f"core/{folder}"
        graph.add_node(name, label=_make_label(name), fillcolor=_COMPILED)
    graph.add_edges_from(sorted(find_edges()))
    return graph


def _make_label(title: str, text: str = "") -> str:
    """Returns a bold title over short lines, as Graphviz writes them."""
    lines = "".join(
        f'<BR/><FONT POINT-SIZE="10">{escape(line)}</FONT>'
        for line in textwrap.wrap(text.replace("`", ""), 26, break_on_hyphens=False)
    )
    return f"<<B>{title}</B>{lines}>"


def main() -> None:
    """Draws it."""
    make_graph().draw(PICTURE, format="svg", prog="dot")
    print(PICTURE)


if __name__ == "__main__":
    main()
