"""Test that a program that uses the package gets types for all of it."""

from __future__ import annotations

import ast
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

import drake_haptics

PROGRAM = Path(__file__).with_name("whole_api.py")


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


def check(python: Path, program: str, *more: str) -> str:
    """Returns what mypy says of a program, with no setting but --strict and more."""
    folder = python.parents[1]
    (folder / "program.py").write_text(program)
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file="]
    command += ["--python-executable", str(python), *more, "program.py"]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=False
    )
    return done.stdout + done.stderr


def test_a_consumer_is_checked_strictly_and_meets_no_any(python: Path) -> None:
    said = check(python, PROGRAM.read_text(), "--disallow-any-expr")
    assert said.startswith("Success"), said


def test_mistakes_of_a_consumer_are_found(python: Path) -> None:
    said = check(
        python,
        "import drake_haptics as dh\n"
        "dh.no_such_name\n"
        "dh.load_mesh(3)\n"
        "dh.RealTimePacer('fast')\n"
        "for contact in dh.SceneTracker(1, [], 0.1).query(''):\n"
        "    contact.depth\n",
    )
    for line in (3, 4, 5, 6):
        assert f"program.py:{line}: error" in said, said


def test_the_program_uses_every_public_name() -> None:
    tree = ast.parse(PROGRAM.read_text())
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert set(drake_haptics.__all__) - used == set()
