"""Test what the package offers by name, and that geometry needs no Drake."""

from __future__ import annotations

import ast
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

import drake_haptics


@pytest.mark.parametrize("name", drake_haptics.__all__)
def test_every_public_name_is_there_and_documented(name: str) -> None:
    assert name in dir(drake_haptics)
    assert getattr(drake_haptics, name).__doc__


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no_such_thing"):
        _ = drake_haptics.no_such_thing


def test_a_mistyped_name_is_told_what_was_probably_meant() -> None:
    with pytest.raises(AttributeError, match="did you mean 'load_mesh'"):
        _ = drake_haptics.lod_mesh


def test_a_module_that_is_not_imported_yet_is_named_as_one() -> None:
    program = (
        "import drake_haptics\n"
        "try:\n"
        "    drake_haptics.geometry\n"
        "except AttributeError as error:\n"
        "    print(error)\n"
    )
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    assert "import drake_haptics.geometry" in done.stdout


def test_the_version_is_that_of_the_installed_package() -> None:
    assert drake_haptics.__version__ == metadata.version("drake_haptics")
    assert "__version__" in dir(drake_haptics)


def test_the_names_are_told_to_type_checkers_from_where_they_come() -> None:
    """The package's file lists them three times: for checkers, `import *` and use."""
    source = Path(drake_haptics.__file__).read_text()
    told = {
        alias.name: node.module
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
        if node.module.startswith("drake_haptics.")
    }
    kept = {
        name: f"drake_haptics.{module}"
        for name, module in drake_haptics._MODULE_OF.items()
    }
    assert told == kept
    assert sorted(kept) == drake_haptics.__all__


def test_the_geometry_imports_no_drake() -> None:
    program = (
        "import sys, drake_haptics\n"
        "drake_haptics.load_mesh, drake_haptics.decompose\n"
        "assert not any(m.startswith('pydrake') for m in sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)
