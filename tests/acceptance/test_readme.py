"""What the README says to type works, and what it shows exists."""

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from drake_haptics.cli import main
from drake_haptics.scene_library import list_scenes

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = [
    line.split("#")[0].strip()
    for block in re.findall(r"```sh\n(.*?)```", README, re.DOTALL)
    for line in block.splitlines()
    if line.strip()
]
HAPTICS = [line for line in COMMANDS if line.startswith("drake-haptics")]


@pytest.mark.parametrize("line", HAPTICS)
def test_command_runs(line, tmp_path, monkeypatch):
    # Files that the command reads are in the checkout; what it writes goes elsewhere.
    (tmp_path / "models").symlink_to(ROOT / "models")
    monkeypatch.chdir(tmp_path)
    arguments = shlex.split(line)[1:]
    if arguments[0] == "run":
        if "--duration" in arguments:
            arguments[arguments.index("--duration") + 1] = "0.3"
        else:
            arguments += ["--duration", "0.3"]
        if "--headless" not in arguments:
            arguments.append("--headless")
    if arguments[0] == "stability":
        arguments += ["--map", "0"]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0, result.output
    for option in ("--record", "--json"):
        if option in arguments:
            assert Path(arguments[arguments.index(option) + 1]).stat().st_size > 0


def test_the_other_commands_are_targets_of_the_makefile():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    others = [line for line in COMMANDS if line not in HAPTICS]
    assert others[:2] == ["make demo", "make test"]
    for line in others:
        program, target = line.split()
        assert program == "make"
        assert re.search(rf"^{target}:", makefile, re.MULTILINE)


def test_the_python_example_is_short_and_runs(capsys):
    (block,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    assert len([line for line in block.splitlines() if line.strip()]) <= 12
    exec(compile(block, "README.md", "exec"), {"__name__": "readme"})
    assert "N" in capsys.readouterr().out


def test_the_table_has_every_scene():
    rows = re.findall(r"^\| `(\w+)` \|", README, re.MULTILINE)
    assert sorted(rows) == sorted(list_scenes())


@pytest.mark.parametrize("target", re.findall(r"\]\(([^)#:]+)\)", README))
def test_links_lead_somewhere(target):
    assert (ROOT / target).exists()
