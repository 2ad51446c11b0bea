"""The real command in a real terminal (a pty), in a pipe, and with odd streams."""

import json
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import time
from fcntl import ioctl
from pathlib import Path
from termios import TIOCSWINSZ

import pytest
import trimesh

COMMAND = str(Path(sys.executable).with_name("drake-haptics"))
WIDTH = 72
# ESC [ ... m with a color in it, as against bold and dim.
COLOR = re.compile(r"\x1b\[(?:\d+;)*(?:3[0-7]|9[0-7])(?:;\d+)*m")
RUN = ["run", "sphere_pen", "--headless"]


def in_terminal(*arguments, interrupt_after=None, **variables):
    """Runs the command on a terminal of its own.

    Args:
        arguments: Of the command.
        interrupt_after: Ctrl-C is typed once this has been written.
        variables: Of the environment.

    Returns:
        What the terminal got, and the exit code.
    """
    # Readline, which pytest imports, leaves a size in the environment.
    left_out = {"NO_COLOR", "COLUMNS", "LINES"}
    environment = {k: v for k, v in os.environ.items() if k not in left_out}
    pid, terminal = pty.fork()
    if pid == 0:  # pragma: no cover
        environment |= {"TERM": "xterm-256color", **variables}
        os.execve(COMMAND, [COMMAND, *arguments], environment)
    ioctl(terminal, TIOCSWINSZ, struct.pack("HHHH", 24, WIDTH, 0, 0))
    output, end_s = b"", time.monotonic() + 180.0
    while select.select([terminal], [], [], max(0.0, end_s - time.monotonic()))[0]:
        try:
            output += os.read(terminal, 4096)
        except OSError:  # Linux: the other end is closed
            break
        if interrupt_after is not None and interrupt_after.encode() in output:
            os.write(terminal, b"\x03")
            interrupt_after = None
    else:
        os.kill(pid, signal.SIGKILL)
    _, status = os.waitpid(pid, 0)
    return output.decode(), os.waitstatus_to_exitcode(status)


@pytest.mark.parametrize(
    ("command", "shown"), [("run", b"x real time"), ("device", b" Hz")]
)
def test_a_terminal_that_is_closed_does_not_take_the_figures_with_it(
    tmp_path, command, shown
):
    file = tmp_path / "figures.json"
    options = ["--headless"] if command == "run" else ["--port", "0"]
    words = [COMMAND, command, "sphere_pen", *options, "--json", str(file)]
    pid, terminal = pty.fork()
    if pid == 0:  # pragma: no cover
        os.execv(COMMAND, words)
    ioctl(terminal, TIOCSWINSZ, struct.pack("HHHH", 24, WIDTH, 0, 0))
    output, end_s = b"", time.monotonic() + 180.0
    while shown not in output:
        assert select.select([terminal], [], [], 180.0)[0]
        assert time.monotonic() < end_s, output
        output += os.read(terminal, 4096)
    os.close(terminal)
    os.waitpid(pid, 0)
    assert json.loads(file.read_text())["duration_s"] > 0.0


def in_pipe(*arguments, **settings):
    return subprocess.run(
        [COMMAND, *arguments], capture_output=True, text=True, timeout=180, **settings
    )


@pytest.fixture(scope="module")
def shown():
    return in_terminal(*RUN, "--duration", "8")


def test_a_terminal_gets_a_line_that_changes_and_leaves_nothing_behind(shown):
    output, code = shown
    assert code == 0
    assert output.count("x real time") >= 2
    assert "\x1b[2K" in output or "\x1b[1A" in output  # the line is taken away
    # What remains: the rows of the summary, none cut.
    rest = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", output).rpartition("x real time")[2]
    assert "device limit" in rest and "ran" in rest


def test_no_line_is_wider_than_the_terminal(shown):
    plain = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown[0])
    assert max(map(len, re.split(r"[\r\n]+", plain))) <= WIDTH


def test_colors_are_for_terminals_without_no_color(tmp_path):
    box = trimesh.creation.box([0.1, 0.1, 0.1])
    box.update_faces([True] * 11 + [False])
    box.export(tmp_path / "open.stl")
    colored, _ = in_terminal("check", str(tmp_path / "open.stl"))
    assert COLOR.search(colored)
    plain, code = in_terminal("check", str(tmp_path / "open.stl"), NO_COLOR="1")
    assert code == 0 and "holes" in plain and not COLOR.search(plain)


def test_a_pipe_gets_whole_lines_and_neither_colors_nor_noise(tmp_path):
    page, figures = tmp_path / "a[b].html", tmp_path / "f.json"
    result = in_pipe(*RUN, "--duration", "0.5", "--record", page, "--json", figures)
    assert (result.returncode, result.stderr) == (0, "")
    assert "\x1b" not in result.stdout and "x real time" not in result.stdout
    # One line each, however long, and names as they are.
    (wrote,) = [x for x in result.stdout.splitlines() if x.startswith("Wrote")]
    assert wrote == f"Wrote {page}."
    assert json.loads(figures.read_text())["ticks"] == 500


def test_ctrl_c_is_one_line():
    output, code = in_terminal("paper", "figure12", interrupt_after="\x1b")
    assert code == 130
    assert "Stopped." in output and "Traceback" not in output
    assert "Aborted" not in output


def test_a_reader_that_goes_is_no_error():
    script = f"set -o pipefail; {COMMAND} devices --json - | head -n 1"
    result = subprocess.run(
        ["bash", "-c", script], capture_output=True, text=True, timeout=180
    )
    assert (result.stdout, result.stderr) == ("{\n", "")


def test_a_disk_that_is_full_is_told():
    with open("/dev/full", "w") as full:
        result = subprocess.run(
            [COMMAND, "devices"], stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert result.returncode == 1
    assert result.stderr.splitlines() == [
        "Error: No space left on device; free some space, or write to another disk"
    ]


def test_the_plainest_locale_is_served():
    result = in_pipe("devices", env={**os.environ, "LC_ALL": "C", "LANG": "C"})
    assert result.returncode == 0 and "phantom_premium_1_5_6dof" in result.stdout
