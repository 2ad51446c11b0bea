"""Exit codes and the words beside them: one table, held for every kind of end."""

import errno
import logging
import re
import warnings
from pathlib import Path

import pytest
from command_line import invoke

from drake_haptics.cli import meshes as command
from drake_haptics.cli.endings import ExitCode
from drake_haptics.common.errors import HapticsError

PAGE = Path(__file__).resolve().parents[2] / "docs" / "command-line.md"


@pytest.fixture
def end_with(monkeypatch):
    """Returns what runs `check` where reading a mesh ends with an exception."""

    def run(error, *options):
        def fail(*_, **__):
            raise error

        monkeypatch.setattr(command, "read_mesh", fail)
        return invoke(*options, "check", "cup.obj")

    return run


ENDS = [
    (HapticsError("the mesh has no triangles"), 1, "Error: the mesh has no triangles"),
    (
        OSError(errno.EACCES, "Permission denied", "x.obj"),
        1,
        "x.obj: Permission denied",
    ),
    (OSError(errno.ENOSPC, "No space left on device"), 1, "free some space"),
    (MemoryError(), 1, "--max-triangles"),
    (ModuleNotFoundError("No module named 'x'", name="trimesh"), 1, "pip install trim"),
    (ZeroDivisionError("float division"), 70, "a defect of drake-haptics, not of your"),
    (ModuleNotFoundError("gone", name="drake_haptics.gone"), 70, "a defect of"),
    (KeyboardInterrupt(), 130, "Stopped."),
    (KeyboardInterrupt("Stopped. 3 of 9 are kept"), 130, "Stopped. 3 of 9 are kept"),
]


@pytest.mark.parametrize(("error", "code", "words"), ENDS, ids=lambda x: str(x)[:20])
def test_every_end_is_a_line_and_a_code(end_with, error, code, words):
    result = end_with(error)
    assert result.exit_code == code
    (line,) = result.stderr.splitlines()
    assert words in line and result.stdout == ""


@pytest.mark.parametrize("error", [HapticsError("no"), ZeroDivisionError("0")])
@pytest.mark.parametrize("how", ["option", "variable"])
def test_debug_shows_where_it_came_from(end_with, monkeypatch, error, how):
    if how == "variable":
        monkeypatch.setenv("DRAKE_HAPTICS_DEBUG", "1")
    result = end_with(error, *(["--debug"] if how == "option" else []))
    quiet = 70 if isinstance(error, ZeroDivisionError) else 1
    assert result.exit_code == quiet
    assert "Traceback (most recent call last)" in result.stderr
    assert result.stderr.splitlines()[-1].startswith("Error: ")


def test_debug_behind_the_command_is_told_where_it_goes():
    result = invoke("check", "cup.obj", "--debug")
    assert result.exit_code == 2
    assert "goes before the command: drake-haptics --debug" in result.stderr


def test_a_defect_is_ours_and_says_what_to_report(end_with):
    line = end_with(IndexError("list index\nout of range")).stderr
    assert "IndexError: list index out of range" in line
    assert re.search(r"\(cli/meshes\.py:\d+\)", line)
    assert "report it" in line and "`drake-haptics --debug`" in line


def test_warnings_and_logs_are_a_line_each(monkeypatch):
    def complain(*_, **__):
        warnings.warn("DrakeDeprecationWarning:\n   use Other", stacklevel=1)
        for _ in range(2):
            logging.getLogger("drake").warning("slow %s", "mesh")
        logging.getLogger("drake").info("Meshcat listening")
        raise HapticsError("enough")

    monkeypatch.setattr(command, "read_mesh", complain)
    before = (warnings.showwarning, list(logging.root.handlers))
    result = invoke("check", "cup.obj")
    assert result.stderr.splitlines() == [
        "Warning: DrakeDeprecationWarning: use Other",
        "Warning: slow mesh",
        "Error: enough",
    ]
    assert (warnings.showwarning, list(logging.root.handlers)) == before


def test_the_page_has_the_table():
    rows = re.findall(r"^\| (\d+) \| ", PAGE.read_text(encoding="utf-8"), re.M)
    assert [int(code) for code in rows] == sorted(ExitCode)
