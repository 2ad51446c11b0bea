"""Test what the package offers by name, and that geometry needs no Drake."""

from __future__ import annotations

import ast
import inspect
import pkgutil
import subprocess
import sys
from importlib import import_module, metadata
from pathlib import Path

import pytest
from pydrake.systems.framework import System

import drake_haptics
import drake_haptics.systems

# The documented places to import from.
PLACES = ["", ".analysis", ".geometry", ".simulation", ".systems"]


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
        "    drake_haptics.scene\n"
        "except AttributeError as error:\n"
        "    print(error)\n"
    )
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    assert "import drake_haptics.scene" in done.stdout


def test_the_version_is_that_of_the_installed_package() -> None:
    assert drake_haptics.__version__ == metadata.version("drake_haptics")
    assert "__version__" in dir(drake_haptics)


@pytest.mark.parametrize("name", PLACES)
def test_the_names_are_told_to_type_checkers_from_where_they_come(name: str) -> None:
    """The stub lists each once: for checkers, `import *` and use."""
    package = import_module(f"drake_haptics{name}")
    stub = Path(package.__file__).with_suffix(".pyi").read_text()
    told = {}
    for node in ast.walk(ast.parse(stub)):
        if isinstance(node, ast.ImportFrom):
            module = import_module(f"{package.__name__}.{node.module}")
            for alias in node.names:
                assert alias.asname == alias.name not in told  # offered, and once
                told[alias.name] = getattr(module, alias.name)
    assert sorted(told) == sorted(package.__all__)
    for public, value in told.items():
        assert getattr(package, public) is value
        where = getattr(value, "__module__", "")  # constants have none
        assert where in ("", "drake_haptics._core") or where.startswith(
            package.__name__
        )


def test_what_the_parameters_of_a_system_are_set_to_is_public_too() -> None:
    types = {
        list(method.__annotations__.values())[1]
        for name in drake_haptics.systems.__all__
        for word, method in inspect.getmembers(getattr(drake_haptics.systems, name))
        if word.startswith("set_") and inspect.isfunction(method)
    }
    assert {"float", "CouplingGains"} < types
    assert types - {"float"} <= set(drake_haptics.systems.__all__)


def test_a_function_is_offered_also_once_the_module_of_its_name_is_loaded() -> None:
    program = (
        "import drake_haptics.simulation.run\n"
        "from drake_haptics.simulation import run\n"
        "assert run is drake_haptics.run\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


def test_every_system_is_in_the_package_of_systems_by_its_name() -> None:
    package = drake_haptics.systems
    modules = pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    systems = {
        name: value
        for module in modules
        if not module.ispkg
        for name, value in vars(import_module(module.name)).items()
        if isinstance(value, type)
        and issubclass(value, System)
        and value.__module__ == module.name
        and not name.startswith("_")
        and "𝓣" not in name  # an instance of a template has a plain name too
    }
    assert len(systems) > 30
    assert {name: getattr(package, name, None) for name in systems} == systems


def test_systems_are_loaded_when_they_are_asked_for() -> None:
    program = (
        "import sys, drake_haptics.systems as systems\n"
        "assert not any(m.startswith('pydrake') for m in sys.modules)\n"
        "systems.ToolGravity\n"
        "assert 'drake_haptics.systems.tool.tool_gravity' in sys.modules\n"
        "assert not any(m.endswith('.force_shading') for m in sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


def test_the_geometry_imports_no_drake() -> None:
    program = (
        "import sys, drake_haptics, drake_haptics.geometry\n"
        "from drake_haptics.geometry import *\n"
        "drake_haptics.load_mesh, drake_haptics.decompose\n"
        "assert not any(m.startswith('pydrake') for m in sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)
