"""The Tab key, asked as the shells ask: by click's protocol."""

import subprocess
import sys
from pathlib import Path

import pytest
from click.shell_completion import get_completion_class
from command_line import invoke

from drake_haptics.cli import main
from drake_haptics.scene.device_preset import list_device_presets
from drake_haptics.scene.library import list_scenes

BIN = Path(sys.executable).parent


def complete(line):
    """Returns what completes the last word of a line, and of which kind it is."""
    *words, incomplete = line.split(" ")
    shell = get_completion_class("bash")(main, {}, "drake-haptics", "_X")
    return [
        (item.type, item.value) for item in shell.get_completions(words, incomplete)
    ]


def values(line):
    return [value for _, value in complete(line)]


def test_commands_and_options():
    assert values("ch") == ["check"]
    assert values("log re") == ["replay"]
    assert "--headless" in values("run cup_spoon --h")
    assert values("decompose --method m") == ["merged"]


@pytest.mark.parametrize("command", ["run", "device", "stability", "accuracy"])
def test_scenes_that_come_along_then_files(command):
    assert values(f"{command} ") == list(list_scenes())
    assert values(f"{command} cup_") == ["cup_spoon"]
    assert complete(f"{command} my") == [("file", "my")]


def test_devices_by_kind_of_address():
    kinds = {value.partition(":")[0] for value in values("run --device ")}
    assert kinds == {"udp", "mouse", "meshcat", "haply", "lcm", "replay"}
    assert values("run --device mo") == ["mouse:"]


def test_units_and_mesh_files():
    assert values("check --unit m") == ["m", "mm"]
    for line in ("check cu", "run --tool cu", "run --environment cu"):
        assert complete(line) == [("file", "cu")]


@pytest.mark.parametrize(
    "line",
    ["accuracy --only ", "log replay a.tick --set ", "run can_box --set ",
     "stability can_box --set ", "accuracy --set ", "device --set "],
)  # fmt: skip
def test_keys_of_a_scene_and_devices_for_it(line):
    assert values(f"{line}contact.tol") == ["contact.tolerance_m="]
    assert "effects.friction.coefficient=" in values(f"{line}effects.")
    presets = [f"device.preset={name}" for name in list_device_presets()]
    assert values(f"{line}device.preset=") == presets
    assert values(f"{line}contact.tolerance_m=") == []
    # Of all objects, and of one.
    for which in ("environment.", "environment[0]."):
        assert values(f"{line}{which}sc") == [f"{which}scale="]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_script_for_each_shell_says_where_it_belongs(shell):
    result = invoke("completion", shell)
    assert result.exit_code == 0, result.output
    first, *rest = result.stdout.splitlines()
    assert first.startswith("# ") and f"drake-haptics completion {shell}" in first
    assert f"_DRAKE_HAPTICS_COMPLETE={shell}_complete" in "\n".join(rest)


def test_the_shell_of_the_user_is_taken_or_told(monkeypatch):
    monkeypatch.setenv("SHELL", "/usr/bin/zsh")
    assert "#compdef drake-haptics" in invoke("completion").stdout
    monkeypatch.setenv("SHELL", "/bin/tcsh")
    result = invoke("completion")
    assert result.exit_code == 1 and "'tcsh': name bash, zsh, fish" in result.stderr


def test_bash_itself_completes():
    # The function that bash calls at Tab, called for `drake-haptics run to`.
    script = f"""
    PATH={BIN}:$PATH; eval "$(drake-haptics completion bash)"
    COMP_WORDS=(drake-haptics run to) COMP_CWORD=2
    _drake_haptics_completion drake-haptics; echo "${{COMPREPLY[@]}}"
    """
    result = subprocess.run(
        ["bash", "-c", script], capture_output=True, text=True, timeout=180
    )
    assert (result.stdout, result.stderr) == ("torus_peg\n", "")
