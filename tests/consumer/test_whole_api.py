"""Test that a program that uses the package gets types for all of it."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

import drake_haptics

PROGRAM = Path(__file__).with_name("whole_api.py")
MISTAKES = """import drake_haptics as dh
dh.no_such_name
dh.load_mesh(3)
dh.RealTimePacer('fast')
for contact in dh.SceneTracker(1, [], 0.1).query(''):
    contact.depth
"""
# Line and kind of each.
FOUND = {3: "arg-type", 4: "arg-type", 5: "arg-type", 6: "attr-defined"}


@pytest.fixture(scope="module")
def python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An environment with the package in its site-packages, as a wheel puts it there.

    Type checkers follow no import hooks, by which an editable package is found.
    """
    folder = tmp_path_factory.mktemp("environment")
    venv.create(folder, symlinks=True)
    [site] = folder.glob("lib/python*/site-packages")
    (site / "others.pth").write_text(sysconfig.get_path("purelib"))
    (site / "drake_haptics").symlink_to(Path(drake_haptics.__file__).parent)
    return folder / "bin" / "python"


@pytest.fixture(scope="module")
def said(python: Path) -> list[str]:
    """What mypy says of both programs, with no settings but two that are strict."""
    folder = python.parents[1]
    (folder / "program.py").write_text(PROGRAM.read_text())
    (folder / "mistakes.py").write_text(MISTAKES)
    command = [sys.executable, "-m", "mypy", "--strict", "--disallow-any-expr"]
    command += ["--config-file=", "--python-executable", str(python)]
    done = subprocess.run(
        [*command, "program.py", "mistakes.py"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    return (done.stdout + done.stderr).splitlines()


def test_a_consumer_is_checked_strictly_and_meets_no_any(said: list[str]) -> None:
    assert said[-1].endswith("in 1 file (checked 2 source files)")
    assert [line for line in said[:-1] if not line.startswith("mistakes.py:")] == []


def test_mistakes_of_a_consumer_are_found(said: list[str]) -> None:
    text = "\n".join(said)
    for line, kind in FOUND.items():
        assert re.search(rf"mistakes\.py:{line}: error: .*\[{kind}\]", text), text


def test_the_program_uses_every_public_name() -> None:
    tree = ast.parse(PROGRAM.read_text())
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert set(drake_haptics.__all__) - used == set()
