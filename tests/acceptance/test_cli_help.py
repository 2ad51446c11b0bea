"""`--help` of every command: complete, readable, and its examples run."""

import shlex
import subprocess
import sys
from pathlib import Path

import click
import pytest
import trimesh
from click.testing import CliRunner
from shapes import SHAPES

from drake_haptics.cli import main
from drake_haptics.cli.command_help import LazyGroup
from drake_haptics.scene.library import list_scenes


def find_commands(group=main, words=()):
    """Returns all commands by the words that call them, groups among them."""
    found = {words: group}
    if isinstance(group, LazyGroup):
        ctx = click.Context(group)
        for name in group.list_commands(ctx):
            found |= find_commands(group.get_command(ctx, name), (*words, name))
    return found


COMMANDS = find_commands()
EXAMPLES = sorted(
    {x for command in COMMANDS.values() for x in command.help_entry.examples.values()}
)
# What makes a run short, or takes the place of what goes on until Ctrl-C.
SHORTER = {
    "run": ["--headless", "--duration", "0.02"],
    "device": ["--port", "0", "--duration", "0.1"],
}
# These take from seconds to minutes, and have tests of their own; or no file is there.
ONLY_PARSED = ("accuracy", "bench", "paper", "stability")


def show_help(words):
    result = CliRunner().invoke(main, [*words, "--help"], terminal_width=78)
    assert result.exit_code == 0, result.output
    return result.output


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_help_is_complete_and_fits_a_terminal(words):
    text = show_help(words)
    lines = text.splitlines()
    assert max(map(len, lines)) <= 80
    assert "Examples:\n" in text and "\n    drake-haptics" in text.replace(
        'eval "$(', ""
    )
    # Names are to be copied, so none is broken into two lines.
    assert not any(x.endswith("-") and not x.endswith(" -") for x in lines)
    command = COMMANDS[words]
    assert command.help.splitlines()[0].endswith(".")
    for option in command.params:
        if isinstance(option, click.Option):
            assert option.help and option.help.rstrip()[-1] in ".]", option.name
            kind = option.make_metavar(click.Context(command))
            # A bare kind says neither what is meant nor in which unit.
            assert kind not in ("TEXT", "INTEGER", "FLOAT"), option.name
            assert "RANGE" not in kind, option.name


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_help_tells_exit_codes_where_there_is_more_than_done(words):
    lists = [("scenes",), ("devices",), ("completion",), ("log",)]
    assert ("Exit code:\n  0: " in show_help(words)) is (words not in lists)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Holds the files that the examples name."""
    folder = tmp_path_factory.mktemp("examples")
    SHAPES["cup"]().write_obj(folder / "cup.obj", "cup")
    for shape, name in (("pen", "pen.stl"), ("cup", "mug.stl")):
        meters = SHAPES[shape]()
        trimesh.Trimesh(1e3 * meters.vertices, meters.triangles).export(folder / name)
    trimesh.creation.box([50.0, 20.0, 10.0]).export(folder / "my_mesh.stl")
    return folder


@pytest.fixture(scope="module")
def logs(folder):
    """Holds the logs that examples read, of short runs."""
    for name in ("run", "new"):
        arguments = [
            "run",
            "cup_spoon",
            *SHORTER["run"],
            "--log",
            f"{folder}/{name}.tick",
        ]
        assert CliRunner().invoke(main, arguments).exit_code == 0
    return folder


@pytest.mark.parametrize("line", [e for e in EXAMPLES if e.startswith("drake-haptics")])
def test_an_example_runs(line, logs, monkeypatch):
    monkeypatch.chdir(logs)
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(logs / "cache"))
    _, *words = shlex.split(line.partition(" | ")[0])
    name = words[0]
    if "--device" in words:
        # No page and no driver here: the address is parsed by tests of its own.
        at = words.index("--device")
        del words[at : at + 2]
    if name in ONLY_PARSED:
        command = COMMANDS[name,]
        assert command.make_context(name, words[1:])
        assert not {"SCENE"} & set(words) and set(words[1:2]) <= {
            *list_scenes(), "loop", "table1", "--out"
        }  # fmt: skip
        return
    result = CliRunner().invoke(main, [*words, *SHORTER.get(name, [])])
    allowed = (0, 3) if words[:2] == ["log", "diff"] else (0,)
    assert result.exit_code in allowed, result.output


def test_examples_of_the_shell_are_the_shells_own():
    others = [line for line in EXAMPLES if not line.startswith("drake-haptics")]
    script = "; ".join(line.partition(" >> ")[0] for line in others)
    folder = Path(sys.executable).parent
    result = subprocess.run(
        ["bash", "-c", f"PATH={folder}:$PATH; {script}; complete -p drake-haptics"],
        capture_output=True, text=True, timeout=180,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    assert "_drake_haptics_completion drake-haptics" in result.stdout


def test_alone_it_shows_where_to_start():
    result = CliRunner().invoke(main, [])
    assert result.exit_code == 0
    assert "drake-haptics run cup_spoon" in result.output
    for name in main.list_commands(click.Context(main)):
        assert f"\n  {name} " in result.output


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (["chekc"], "did you mean 'check'?"),
        (["log", "inof"], "did you mean 'info'?"),
        (["xyz"], "there are run, device"),
        (["run", "--headles"], "--headless"),
        (["--debgu", "run"], "--debug"),
    ],
)
def test_a_slip_of_the_hand_is_understood(words, meant):
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 2 and meant in result.stderr
