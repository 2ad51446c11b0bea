"""`run --log` and `drake-haptics log` from end to end."""

import csv
import io
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from command_line import COMMAND, call, invoke
from driver_process import device_command, running

from drake_haptics.cli import run_session
from drake_haptics.device.udp_device import UdpDevice
from drake_haptics.tick_log.tick_log import read_tick_log

LONG_S = 300.0


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A log that another process has written."""
    path = tmp_path_factory.mktemp("log") / "run.tick"
    arguments = ["run", "rubbed_sphere", "--headless", "--duration", "1.5"]
    answer = call(*arguments, "--log", path)
    assert answer.returncode == 0, answer.stderr
    assert f"Wrote {path}" in answer.stdout.replace("\n", "")
    return path


def test_info_says_what_is_in_it(log):
    output = invoke("log", "info", log).output
    assert "1500, 1.500 s at 1000 Hz" in output
    assert "simulated" in output
    assert "complete" in output
    data = json.loads(invoke("log", "info", log, "--json", "-").output)
    assert (data["ticks"], data["gaps"], data["changed_meshes"]) == (1500, [], [])
    assert data["bytes"] == log.stat().st_size
    assert 0.1 < data["max_force_N"] < 8.5
    assert "friction" in data["header"]["scene"]


def test_a_replay_in_another_process_is_equal_to_the_last_bit(log, tmp_path):
    answer = invoke("log", "replay", log, "--log", tmp_path / "again.tick")
    assert answer.exit_code == 0
    assert "All 1,500 ticks are equal to the last bit." in answer.output
    assert answer.output.endswith(f"\nWrote {tmp_path / 'again.tick'}.\n")
    answer = invoke("log", "diff", log, tmp_path / "again.tick")
    assert answer.exit_code == 0
    assert "equal to the last bit" in answer.output


def test_a_replay_with_another_stiffness_is_compared_and_drawn(log, tmp_path):
    again, picture = tmp_path / "soft.tick", tmp_path / "diff.png"
    stiffness = "contact.stiffness_N_per_m=500"
    answer = invoke("log", "replay", log, "--set", stiffness, "--log", again)
    assert answer.exit_code == 0
    assert (
        "The scenes differ:\n  contact.stiffness_N_per_m: 2000.0, 500.0\n"
        in answer.output
    )
    assert "X_WT position" in answer.output
    answer = invoke("log", "diff", log, again, "--plot", picture)
    assert answer.output.endswith(f"\nWrote {picture}.\n")
    answer = invoke("log", "diff", log, again, "--plot", picture, "--json", "-")
    assert answer.exit_code == 3
    data = json.loads(answer.output)
    assert not data["is_bit_equal"]
    by_name = {quantity["name"]: quantity for quantity in data["quantities"]}
    assert by_name["X_WH position"]["differing"] == 0
    assert by_name["X_WT position"]["largest"] > 1e-4
    assert matplotlib.image.imread(picture).std() > 0.05


def test_a_replay_into_another_scene_file(log, tmp_path):
    answer = invoke("log", "replay", log, "sphere_pen", "--json", "-")
    assert answer.exit_code == 0
    data = json.loads(answer.output)
    assert data["ticks"] == 1500
    assert not data["diff"]["same_scene"]
    answer = invoke("log", "replay", log, "--set", "device.rate_hz=500")
    assert answer.exit_code == 0
    assert "nothing to compare tick by tick" in answer.output


def test_csv_has_every_tick(log, tmp_path):
    out = tmp_path / "run.csv"
    assert invoke("log", "csv", log, "--out", out).exit_code == 0
    text = (tmp_path / "run.csv").read_text()
    lines = list(csv.DictReader(io.StringIO(text)))
    rows = read_tick_log(log).rows
    assert len(lines) == len(rows) == 1500
    column = [float(line["F_Ho_W_commanded_fz_N"]) for line in lines]
    assert column == rows["F_Ho_W_commanded"][:, 5].tolist()
    assert invoke("log", "csv", log, "--out", "-").output == text


def test_csv_is_named_after_its_log(log, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    answer = invoke("log", "csv", log)
    assert answer.output == f"Wrote {log.stem}.csv.\n"
    assert (tmp_path / f"{log.stem}.csv").stat().st_size > 1000
    # There is one way to say where to.
    assert invoke("log", "csv", log, "other.csv").exit_code == 2


def test_a_table_does_not_take_the_place_of_its_log(log):
    before = log.read_bytes()
    answer = invoke("log", "csv", log, "--out", log)
    assert answer.exit_code == 1 and "is an input of this" in answer.output
    assert log.read_bytes() == before


LOOKS_WITHOUT_DRAKE = """
import sys
from click.testing import CliRunner
from drake_haptics.cli import main
for words in (["info", "LOG"], ["csv", "LOG", "--out", "-"], ["diff", "LOG", "LOG"]):
    words = ["log"] + [sys.argv[1] if word == "LOG" else word for word in words]
    assert CliRunner().invoke(main, words).exit_code == 0
print(sorted({"pydrake", "matplotlib"} & sys.modules.keys()))
"""


def test_to_look_into_a_log_needs_no_drake(log):
    answer = subprocess.run(
        [sys.executable, "-c", LOOKS_WITHOUT_DRAKE, str(log)],
        capture_output=True,
        text=True,
        timeout=LONG_S,
    )
    assert answer.stdout == "[]\n", answer.stderr


def test_a_damaged_log_is_used_as_far_as_it_goes(log, tmp_path):
    data = bytearray(log.read_bytes())
    data[len(data) // 2] ^= 0x10
    broken = tmp_path / "broken.tick"
    broken.write_bytes(data)
    answer = invoke("log", "info", broken)
    assert answer.exit_code == 0
    assert "ticks are missing from tick" in answer.output
    answer = invoke("log", "replay", broken)
    assert answer.exit_code == 0
    assert "Warning" in answer.stderr
    assert "only in the first log" in answer.stdout
    # What both have is equal: no table without a row says that it differs.
    assert "common ticks are equal to the last bit." in answer.stdout
    assert "differ" not in answer.stdout
    broken.write_bytes(data[: len(data) // 3])
    answer = invoke("log", "csv", broken, "--out", tmp_path / "broken.csv")
    assert answer.exit_code == 0
    assert "ends without its end mark" in answer.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["info", "none.tick"], "none.tick: No such file"),
        (["info", __file__], "is not a tick log; record one with"),
        (["info", "."], "Is a directory"),
        (["replay", "LOG", "--log", "LOG"], "is an input of this command"),
        (["replay", "LOG", "--set", "contact.stifness=1"], "did you mean"),
        (["replay", "LOG", "no_such_scene"], "neither a scene file in"),
        (["replay", "LOG", "--log", "none/out.tick"], "--log: there is no folder"),
        (["diff", "LOG", "LOG", "--plot", "none/a.png"], "--plot: there is no folder"),
        (["diff", "LOG", "LOG", "--plot", "a.xyz"], "--plot: Format 'xyz'"),
        (["csv", "LOG", "--out", "none/out.csv"], "--out: there is no folder none"),
        (["csv", "LOG", "--out", "/dev/full"], "/dev/full: No space left"),
        (["replay", "LOG", "--log", "/dev/full"], "/dev/full: No space left"),
    ],
)
def test_what_cannot_be_done_is_said_with_status_1(log, arguments, words):
    answer = invoke("log", *[log if x == "LOG" else x for x in arguments])
    assert answer.exit_code == 1, answer.output
    assert words in answer.output
    assert log.stat().st_size > 1000


def test_a_mesh_that_has_changed_is_told(tmp_path):
    cube = tmp_path / "cube.obj"
    source = Path(__file__).parents[2] / "models" / "meshes" / "block.obj"
    cube.write_bytes(source.read_bytes())
    arguments = ["--tool", cube, "--environment", source, "--tool-scale", "0.3"]
    path = tmp_path / "run.tick"
    answer = invoke(
        "run", *arguments, "--headless", "--duration", "0.05", "--log", path
    )
    assert answer.exit_code == 0, answer.output
    assert "changed since" not in invoke("log", "info", path).output
    cube.write_bytes(source.read_bytes() + b"# a word\n")
    assert "changed since" in invoke("log", "info", path).output
    answer = invoke("log", "replay", path)
    assert "is not what it was recorded on" in answer.stderr
    assert "equal to the last bit" in answer.stdout


def test_a_run_over_two_processes_replays_to_the_last_bit(tmp_path, monkeypatch):
    figures, path = tmp_path / "driver.json", tmp_path / "run.tick"
    options = ["--ttl-ms", "1000"]
    with running(
        device_command(figures, *options, scene="rubbed_sphere"), figures
    ) as driver:
        # A busy machine may be late with a command.
        monkeypatch.setattr(
            run_session,
            "open_device",
            lambda *_: UdpDevice("127.0.0.1", driver.port, ttl_s=1.0, hold_s=1.0),
        )
        run = ["run", "rubbed_sphere", "--headless", "--duration", "2"]
        answer = invoke(*run, "--device", "udp://there", "--log", path)
        assert answer.exit_code == 0, answer.output
        driver.end()
    rows = read_tick_log(path).rows
    assert len(rows) == 2000
    # Over a network readings come when they come, some twice or not at all.
    assert (rows["device_time_s"] > 0.0).all()
    assert (np.diff(rows["sequence"].astype(int)) >= 0).all()
    assert rows["contacts"].max() > 0
    answer = invoke("log", "replay", path)
    assert "All 2,000 ticks are equal to the last bit." in answer.output


def test_a_recorded_handle_can_be_held(log, tmp_path):
    run = ["run", "rubbed_sphere", "--headless", "--duration", "0.3", "--device"]
    answer = invoke(*run, f"replay:{log}", "--log", tmp_path / "again.tick")
    assert answer.exit_code == 0, answer.output
    recorded, again = (
        read_tick_log(path).rows["X_WH"][:300]
        for path in (log, tmp_path / "again.tick")
    )
    np.testing.assert_allclose(again, recorded, atol=1e-14)
    answer = invoke(*run, f"replay:{log}", "--log", log)
    assert answer.exit_code == 1
    assert "is an input of this command" in answer.output
    assert len(read_tick_log(log).rows) == 1500


def test_a_run_that_is_killed_leaves_a_log_that_replays(tmp_path):
    path = tmp_path / "run.tick"
    process = subprocess.Popen(
        [COMMAND, "run", "rubbed_sphere", "--headless", "--log", path],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        end = time.monotonic() + LONG_S
        # Until some is on the disk: then it is running, and is killed within a tick.
        while not path.exists() or path.stat().st_size < 200_000:
            assert time.monotonic() < end
            assert process.poll() is None
            time.sleep(0.01)
        os.kill(process.pid, signal.SIGKILL)
        process.wait(LONG_S)
    finally:
        process.kill()
        process.wait()
    assert "ends without its end mark" in invoke("log", "info", path).output
    answer = invoke("log", "replay", path)
    assert answer.exit_code == 0
    assert "ticks are equal to the last bit" in answer.stdout
