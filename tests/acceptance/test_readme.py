"""What the README says to type works, and what it shows exists."""

import json
import re
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from drake_haptics.cli import main
from drake_haptics.scene_library import list_scenes

ROOT = Path(__file__).parents[2]
# The installed command, beside the interpreter.
COMMAND = Path(sys.executable).with_name("drake-haptics")
README = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = [
    line.split("#")[0].strip()
    for block in re.findall(r"```sh\n(.*?)```", README, re.DOTALL)
    for line in block.splitlines()
    if line.strip()
]
HAPTICS = [line for line in COMMANDS if line.startswith("drake-haptics")]
# What measures for minutes is only begun; its own tests let it end.
SHORTER = {
    "stability": ["--map", "0"],
    "accuracy": ["--quick", "--no-peers", "--only", "contact.depth=global"],
    "bench": ["--quick"],
    "paper": ["--quick", "table1"],
}
TWO_TERMINALS = [line for line in HAPTICS if "device" in line.split()[1:]]
TWO_TERMINALS += [line for line in HAPTICS if "--device" in line]


@pytest.mark.parametrize("line", [x for x in HAPTICS if x not in TWO_TERMINALS])
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
    if "--budget-us" in arguments:
        # So much that nothing has to be tried.
        arguments[arguments.index("--budget-us") + 1] = "1e6"
        arguments.append("--quick")
    else:
        arguments += SHORTER.get(arguments[0], [])
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0, result.output
    for option in ("--record", "--json"):
        if option in arguments:
            assert Path(arguments[arguments.index(option) + 1]).stat().st_size > 0


def test_two_commands_close_a_loop_over_two_processes(tmp_path):
    first, second = (shlex.split(line)[1:] for line in TWO_TERMINALS)
    assert second[-1] == "udp://127.0.0.1:7400", "the port that the first one has"
    # The one of the README may be taken here.
    driver = subprocess.Popen(
        [COMMAND, *first, "--port", "0"], stdout=subprocess.PIPE, text=True
    )
    try:
        address = None
        while address is None:
            address = re.search(r"udp://[\d.:]+", driver.stdout.readline())
        second[-1] = address.group()
        file = tmp_path / "figures.json"
        subprocess.run(
            [COMMAND, *second, "--headless", "--duration", "2", "--json", file],
            check=True,
            timeout=120,
        )
        figures = json.loads(file.read_text())
        assert figures["device"]["received"] > 100
        assert figures["max_force_N"] > 0.3, "the spoon has met the cup"
    finally:
        driver.send_signal(signal.SIGINT)
        assert driver.wait(30) == 0


def test_the_other_commands_are_targets_of_the_makefile():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    others = [line for line in COMMANDS if line not in HAPTICS]
    assert others[:2] == ["make demo", "make test"]
    for line in others:
        program, target = line.split()
        assert program == "make"
        assert re.search(rf"^{target}:", makefile, re.MULTILINE)


@pytest.fixture
def run_python(capsys, monkeypatch):
    """Runs a Python example of a section, of few lines, and returns what it prints."""
    monkeypatch.chdir(ROOT)

    def run(section, most_lines):
        text = README.split(f"\n## {section}\n")[1].split("\n## ")[0]
        (block,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        assert len([line for line in block.splitlines() if line.strip()]) <= most_lines
        exec(compile(block, "README.md", "exec"), {"__name__": "readme"})
        return capsys.readouterr().out

    return run


def test_the_python_example_is_short_and_runs(run_python):
    assert "N" in run_python("From Python", 12)


def test_a_die_lies_in_the_cup_of_ones_own_plant(run_python):
    printed = run_python("In your own Drake simulation", 32)
    height_mm, force_N = map(float, re.findall(r"\d+\.\d+", printed))
    assert force_N == pytest.approx(0.1 * 9.81, abs=0.006)
    # Its corners, 14 mm from the middle, are over a bottom that rises from 5 to 6 mm at
    # 22 mm, within the tolerance of 2 mm. The rim is at 72 mm.
    bottom_mm = 5.0 + 14.1 / 22.0
    assert bottom_mm + 10.0 < height_mm < bottom_mm + 10.0 + 2.0


def test_the_table_has_every_scene():
    rows = re.findall(r"^\| `(\w+)` \|", README, re.MULTILINE)
    assert sorted(rows) == sorted(list_scenes())


@pytest.mark.parametrize("target", re.findall(r"\]\(([^)#:]+)\)", README))
def test_links_lead_somewhere(target):
    assert (ROOT / target).exists()
