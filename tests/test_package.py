"""Test what the package offers by name, and that geometry needs no Drake."""

from __future__ import annotations

import subprocess
import sys

import pytest

import drake_haptics


@pytest.mark.parametrize("name", drake_haptics.__all__)
def test_every_public_name_is_there_and_documented(name: str) -> None:
    assert name in dir(drake_haptics)
    assert getattr(drake_haptics, name).__doc__


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no_such_thing"):
        _ = drake_haptics.no_such_thing


def test_the_geometry_imports_no_drake() -> None:
    program = (
        "import sys, drake_haptics\n"
        "drake_haptics.load_mesh, drake_haptics.decompose\n"
        "assert not any(m.startswith('pydrake') for m in sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)
