"""The modules of the package and what they import, as their sources say."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

# The folders of the package, in order: each imports only from those before it.
ORDER = (
    "models",
    "common",
    "report",
    "device",
    "geometry",
    "tick_log",
    "scene",
    "web",
    "systems",
    "bounds",
    "loop",
    "rendering",
    "simulation",
    "visualization",
    "analysis",
    "authoring",
    "evaluation",
    "cockpit",
    "cli",
)
PACKAGE = "drake_haptics"
CORE = f"{PACKAGE}._core"
# The links of the repository lead to these, and no Python is below the core.
_BESIDE = ("systems", "models")
_NO_PYTHON = ("core", "include")


class Import(NamedTuple):
    """One import of a module of the package by another.

    Attributes:
        importer: The module that imports.
        imported: The module that is imported.
        line: Line of the importer with the import.
    """

    importer: str
    imported: str
    line: int

    def __str__(self) -> str:
        return f"{self.importer}:{self.line} imports {self.imported}"


def find_modules(root: Path) -> dict[str, Path]:
    """Returns the file of each module, by its name; the compiled core has none.

    Args:
        root: Folder of the repository.
    """
    folders = {PACKAGE: root / PACKAGE}
    folders |= {f"{PACKAGE}.{name}": root / name for name in _BESIDE}
    modules = {}
    for package, folder in folders.items():
        for path in sorted(folder.rglob("*.py")):
            parts = path.relative_to(folder).with_suffix("").parts
            if package == PACKAGE and parts[0] in _BESIDE + _NO_PYTHON:
                continue
            name = ".".join([package, *parts])
            modules[name.removesuffix(".__init__")] = path
    return modules


def find_imports(modules: Mapping[str, Path]) -> list[Import]:
    """Returns all imports among modules: top-level, lazy, and for type checkers.

    `from package import module` imports the module, `from module import name` imports
    the module that has the name.
    """
    found = []
    for name, path in modules.items():
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            for imported in _list_imported(node):
                parts = imported.split(".")
                while parts and ".".join(parts) not in {*modules, CORE}:
                    parts.pop()
                if parts:
                    found.append(Import(name, ".".join(parts), node.lineno))
    return found


def _list_imported(node: ast.AST) -> Iterator[str]:
    """Yields what a statement may import, as dotted names."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        # A relative import would not be found: the package has none.
        assert not node.level, ast.unparse(node)
        yield from (f"{node.module}.{alias.name}" for alias in node.names)


def find_upward(imports: Iterable[Import]) -> list[Import]:
    """Returns the imports that go from a folder to one after it.

    The package's own file is after all: it offers the names of all.
    """
    return [
        one for one in imports if _calc_level(one.imported) > _calc_level(one.importer)
    ]


def _calc_level(module: str) -> int:
    """Returns the place of a module's folder in the order; the core is below all."""
    if module == CORE:
        return -1
    return len(ORDER) if module == PACKAGE else ORDER.index(module.split(".")[1])


def find_circles(imports: Iterable[Import]) -> list[list[str]]:
    """Returns the largest sets of modules that each lead to one another."""
    return _find_circles((one.importer, one.imported) for one in imports)


def find_folder_circles(imports: Iterable[Import]) -> list[list[str]]:
    """Returns the circles among the modules and folders of one package.

    Modules and folders of one package are compared; a folder imports what any module
    in it imports.
    """
    edges = set()
    for one in imports:
        a, b = one.importer.split("."), one.imported.split(".")
        shared = next(
            (i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), None
        )
        if shared is not None:  # else the one is the package of the other
            edges.add((".".join(a[: shared + 1]), ".".join(b[: shared + 1])))
    return _find_circles(edges)


def _find_circles(edges: Iterable[tuple[str, str]]) -> list[list[str]]:
    """Returns the strongly connected sets of more than one node."""
    after: dict[str, set[str]] = {}
    for a, b in edges:
        after.setdefault(a, set()).add(b)
        after.setdefault(b, set())
    reached: dict[str, set[str]] = {node: _reach(after, node) for node in after}
    circles = {
        frozenset(b for b in reached[a] if a in reached[b]) | {a}
        for a in after
        if a in reached[a]
    }
    return sorted(sorted(circle) for circle in circles if len(circle) > 1)


def _reach(after: Mapping[str, set[str]], start: str) -> set[str]:
    """Returns all nodes that edges lead to from one."""
    found: set[str] = set()
    rest = list(after[start])
    while rest:
        node = rest.pop()
        if node not in found:
            found.add(node)
            rest += after[node]
    return found
