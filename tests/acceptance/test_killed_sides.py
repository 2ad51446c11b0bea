"""One of two processes is killed in contact: what is said, and what is felt next."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from box_scenes import over_a_plate
from driver_process import COMMAND, WatchedLink, check_figures, running
from host_process import hosting
from pressing_driver import GENTLE_M, LOW_M
from struct_host import ACTIVE, FAULT

PRESSING = Path(__file__).parents[1] / "support" / "pressing_driver.py"
# The cube touches where its middle is 20 mm high. A quarter of the largest force,
# 2.1 N, is that of the coupling, 800 N/m, where the handle is less than 1 mm below.
DEEP_M = 0.0185
LIMIT_N, GENTLE, RISE_S = 8.5, 0.25, 0.2
SCENE = """
tool: {{mesh: {cube}, mass_kg: 0.1}}
environment: [{{name: plate, mesh: {plate}}}]
device: {{base: {{}}}}
hand: {{path: {{waypoints: [{{time_s: 0, position_m: [0, 0, 0.05]}}]}}}}
"""


@pytest.fixture
def scene(tmp_path):
    """A scene whose world is the base of the device."""
    parts = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.05)])
    file = tmp_path / "scene.yaml"
    cube, plate = parts.tool.mesh, parts.environment[0].mesh
    file.write_text(SCENE.format(cube=cube, plate=plate))
    return file


@pytest.fixture
def driver(tmp_path):
    """A handle that presses into the plate."""
    file = tmp_path / "driver.json"
    with running([sys.executable, PRESSING, file], file) as driver:
        yield driver


def test_a_host_that_was_killed_in_contact_begins_gently(tmp_path, scene, driver):
    file = tmp_path / "host.json"
    with WatchedLink(driver.port) as link:
        with hosting(link.port, file, scene=scene) as host:
            # After a fault in contact, a second Enter skips the wait for a low force.
            host.press_enter_until(
                link, lambda s: s.force_N > 5.0, lambda s: not s.force_N
            )
            host.send_signal(signal.SIGKILL)
            last = link.wait_for(lambda s: s.gate != ACTIVE and s.force_N == 0.0)
            assert (last.gate, last.fault) == (FAULT, "STALE")
        seen = len(link.states)
        with hosting(link.port, file, scene=scene) as host:
            first = host.press_enter_until(link, lambda s: s.gate == ACTIVE)
            assert first.X_BH[6] == pytest.approx(LOW_M)
            # Long enough for the force to rise to its limit several times.
            later = first.sequence + 1000
            host.press_enter_until(link, lambda s: s.sequence > later)
            driver.send_signal(signal.SIGUSR1)
            felt = host.press_enter_until(link, lambda s: s.force_N > 1.0)
            assert felt.X_BH[6] == pytest.approx(GENTLE_M)
            host.end()
        link.check_limits()
        states = link.states[seen:]
    assert not any(s.force_N for s in states if s.X_BH[6] < DEEP_M)
    begin = next(s for s in states if s.force_N > 0.0)
    for state in states:
        passed_s = 1e-9 * (state.time_ns - begin.time_ns)
        if 0.0 <= passed_s < RISE_S:
            # Of what is asked for then, as much as has risen.
            share = (passed_s + 0.02) / RISE_S
            assert state.force_N <= GENTLE * LIMIT_N * share
    check_figures(driver.end())


def test_a_driver_that_is_killed_is_told_at_once_and_by_the_exit_code(scene, driver):
    address = f"udp://127.0.0.1:{driver.port}"
    words = ["run", scene, "--device", address, "--headless", "--duration", 30]
    host = subprocess.Popen(
        [str(word) for word in [COMMAND, *words]],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    said = []
    try:
        for line in host.stderr:
            said.append(line)
            if "ACTIVE" in line:
                driver.send_signal(signal.SIGKILL)
            if "FAULT (stale)" in line:
                break
        # The run goes on: nobody has to wait for its end to learn of it.
        assert host.poll() is None, said
        host.send_signal(signal.SIGINT)
        out, rest = host.communicate(timeout=120)
    finally:
        host.kill()
    assert host.returncode == 3, (said, rest)
    # A busy machine may have been late before.
    assert re.search(r"faults: \d+ stale", out), out
    assert "device at fault (stale)" in rest.splitlines()[-1]
