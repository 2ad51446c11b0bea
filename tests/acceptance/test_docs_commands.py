"""Commands that any page names exist, with the options that it gives them."""

import inspect
import re
import shlex
from pathlib import Path

import click
import page_parts
import pytest
from markdown_page import PROGRAM

from drake_haptics.cli import main

ROOT = Path(__file__).parents[2]
PAGES = sorted([*(ROOT / "docs").rglob("*.md"), ROOT / "README.md"])
_PROGRAM = re.compile(
    r"(?:^|[\s`(])python3? ((?:tests|docs|examples)/\S+\.py)([^`\n]*)"
)


def find_commands(text):
    """Returns all that looks like a command of this package, in code of any kind."""
    text = re.sub(r"\\\n\s*", "", text)
    spans = [" ".join(span.split()) for span in re.findall(r"(?s)`([^`]+?)`", text)]
    lines = re.findall(rf"(?m)^(?:    |)(?:\.venv/bin/)?({PROGRAM} .+)$", text)
    found = [*lines, *(span for span in spans if span.startswith(f"{PROGRAM} "))]
    return sorted({command.split(" #")[0].strip() for command in found})


def find_command(words):
    """Returns the command that words of a command line name, and the rest of them."""
    command, rest = main, list(words)
    while isinstance(command, click.Group) and rest and rest[0] != "COMMAND":
        if rest[0].startswith("-"):
            assert rest.pop(0) in list_options(command)
            continue
        named = command.get_command(click.Context(command), rest.pop(0))
        assert named is not None, f"no such command in {words}"
        command = named
    return command, rest


def list_options(command):
    """Returns the options of a command, those for help too."""
    options = {name for parameter in command.params for name in parameter.opts}
    return options | {"--help", "-h"}


CASES = [
    pytest.param(command, id=f"{page.name}: {command}")
    for page in PAGES
    for command in find_commands(page.read_text(encoding="utf-8"))
]


@pytest.mark.parametrize("line", CASES)
def test_a_command_and_its_options_exist(line):
    # Letters for what the reader puts in: SCENE, FILE, [--log OUT].
    words = shlex.split(re.sub(r"[\[\]]|\.\.\.|…", " ", line), comments=True)[1:]
    command, rest = find_command(words)
    options = list_options(command)
    for word in rest:
        if re.match(r"--?[a-z]", word):
            assert word.split("=")[0] in options


PROGRAMS = [
    pytest.param(file, options, id=f"{page.name}: {file}{options}")
    for page in PAGES
    for file, options in _PROGRAM.findall(page.read_text(encoding="utf-8"))
]


@pytest.mark.parametrize(("file", "options"), PROGRAMS)
def test_a_program_of_the_repository_and_its_options_exist(file, options):
    source = (ROOT / file).read_text(encoding="utf-8")
    if "make_parser(" in source:
        source += inspect.getsource(page_parts)
    for option in re.findall(r"--[a-z][\w-]*", options):
        assert f'"{option}"' in source


def test_what_is_none_is_found_out():
    assert find_commands("so `drake-haptics\nrun X --nope`") == [
        "drake-haptics run X --nope"
    ]
    assert find_commands("    drake-haptics a  # why") == ["drake-haptics a"]
    with pytest.raises(AssertionError, match="no such command"):
        find_command(["nope"])
    command, rest = find_command(["log", "replay", "f"])
    assert rest == ["f"] and "--set" in list_options(command)
