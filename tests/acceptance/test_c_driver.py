"""The driver in C of examples/, as a process of its own, against a host in Python."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from c_compiler import compile_c, require_c_compiler
from struct_host import ACTIVE, FAULT, IDLE, StructHost

from drake_haptics.device.backend import DeviceCommand, GateState
from drake_haptics.device.udp_device import UdpDevice

TESTS = Path(__file__).parents[1]
SOURCE = TESTS.parent / "examples" / "device_driver.c"
MAX_FORCE_N, HAND_N_PER_M = 3.3, 300.0
PUSH = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.5])


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """The driver, compiled."""
    return compile_c(
        require_c_compiler(),
        SOURCE,
        to=tmp_path_factory.mktemp("driver") / "device_driver",
        flags=["-std=c99", "-O2"],
    )


@contextmanager
def running(program, port=0):
    """Runs the driver; gives its process and its port."""
    process = subprocess.Popen(
        [program, str(port), "0.5"], stdout=subprocess.PIPE, text=True
    )
    timer = threading.Timer(180.0, process.kill)
    timer.start()
    try:
        address = process.stdout.readline()
        yield process, int(re.search(r"udp://127\.0\.0\.1:(\d+)", address)[1])
    finally:
        timer.cancel()
        process.kill()
        process.wait(10)
        process.stdout.close()


@pytest.fixture
def driver(program):
    """The driver's process and port."""
    with running(program) as driver:
        yield driver


@pytest.fixture
def host(driver):
    """A host of the driver."""
    host = StructHost(driver[1])
    yield host
    host.close()


def receive_until(host, wanted):
    """Listens without a word; returns the state that is as wanted."""
    end_s = time.monotonic() + 120.0
    while time.monotonic() < end_s:
        state = host.receive(0.05)
        if state is not None and wanted(state):
            return state
    raise TimeoutError(f"not reached; the last state was {host.state}")


def test_its_compile_line_can_be_pasted(tmp_path):
    """As it stands, in the folder of the file, to the shell."""
    require_c_compiler()
    if shutil.which("cc") is None:
        pytest.skip("the compiler is not called cc")
    head = SOURCE.read_text(encoding="utf-8").partition("*/")[0]
    commands = re.search(r"^cc .*?(?=^\./)", head, re.MULTILINE | re.DOTALL)[0]
    shutil.copy(SOURCE, tmp_path)
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    environment = {**os.environ, "PATH": path}
    subprocess.run(["sh", "-ec", commands], cwd=tmp_path, env=environment, check=True)
    with running(tmp_path / "device_driver") as (_, port):
        assert port > 0


def test_it_says_nothing_before_it_is_spoken_to(host):
    assert host.receive(0.3) is None
    state = host.disable()
    assert (state.gate, state.session, state.fault) == (IDLE, 0, "NONE")
    assert state.boot != 0
    assert state.max_force_N == pytest.approx(MAX_FORCE_N)
    assert state.max_torque_Nm == 0.0


def test_force_follows_the_command_and_moves_the_handle(host):
    state = host.enable(1.5)
    assert state.session == host.session
    assert state.F_Ho_B == (0.0, 0.0, 0.0, 0.0, 0.0, 1.5)
    z = 1.5 / HAND_N_PER_M
    still = host.exchange(
        lambda s: abs(s.X_BH[6] - z) < 1e-5 and abs(s.V_BH[5]) < 1e-4, force_z=1.5
    )
    assert still.X_BH[:4] == (1.0, 0.0, 0.0, 0.0)
    back = host.exchange(lambda s: s.F_Ho_B[5] == -1.0, force_z=-1.0)
    assert back.gate == ACTIVE


def test_force_is_held_to_the_limit_and_torque_to_none(host):
    host.enable(1.0)
    state = host.exchange(
        lambda s: s.force_N > 1.1, wrench=(1.0, 1.0, 1.0, 30.0, 0.0, 40.0)
    )
    expected = (MAX_FORCE_N * 0.6, 0.0, MAX_FORCE_N * 0.8)
    assert state.F_Ho_B[3:] == pytest.approx(expected)
    assert state.torque_Nm == 0.0


def test_a_host_that_is_killed_leaves_zero_and_a_fault(driver, host):
    _, port = driver
    other = subprocess.Popen(
        [sys.executable, TESTS / "support" / "struct_host.py", str(port), "60", "3"],
        stdout=subprocess.PIPE,
        text=True,
    )
    timer = threading.Timer(180.0, other.kill)
    timer.start()
    try:
        assert other.stdout.readline() == "active\n"
        other.send_signal(signal.SIGKILL)
    finally:
        timer.cancel()
        other.kill()
        other.wait(10)
        other.stdout.close()
    # Enabling is refused, but answered: it is how a host that was killed learns.
    state = host.exchange(lambda s: s.gate == FAULT, enable=True)
    assert (state.fault, state.force_N) == ("STALE", 0.0)
    assert host.enable(2.0).force_N == 2.0


def test_a_silent_host_is_told_of_the_fault_and_recovers(host):
    host.enable(2.0)
    state = receive_until(host, lambda s: s.gate == FAULT)
    assert (state.fault, state.force_N) == ("STALE", 0.0)
    again = host.exchange(lambda s: s.rejected > state.rejected, force_z=2.0)
    assert (again.gate, again.force_N) == (FAULT, 0.0)
    assert host.enable(2.0).force_N == 2.0


def test_a_driver_that_is_restarted_shows_no_force_by_itself(program, driver, host):
    process, port = driver
    boot = host.enable(2.0).boot
    process.kill()
    process.wait(10)
    with running(program, port):
        state = host.exchange(lambda s: s.boot != boot, force_z=2.0)
        for _ in range(50):
            assert (state.gate, state.force_N) == (IDLE, 0.0)
            before = state.rejected
            state = host.exchange(lambda s, n=before: s.rejected > n, force_z=2.0)
        assert host.enable(2.0).force_N == 2.0


def test_the_host_of_the_package_holds_it(driver):
    with UdpDevice("127.0.0.1", driver[1], ttl_s=0.4, hold_s=0.4) as device:
        end_s = time.monotonic() + 120.0
        reading = None
        while time.monotonic() < end_s:
            reading = device.read() or reading
            if reading is not None:
                device.write(DeviceCommand(PUSH, reading.X_BH, reading.V_BH))
                if abs(reading.X_BH[6] - PUSH[5] / HAND_N_PER_M) < 1e-5:
                    break
            time.sleep(0.001)
        assert reading.gate is GateState.ACTIVE
        assert reading.X_BH[6] == pytest.approx(PUSH[5] / HAND_N_PER_M, abs=1e-5)


@pytest.mark.parametrize(
    "number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP]
)
def test_an_interrupt_ends_it_at_zero_force(driver, host, number):
    process, _ = driver
    host.enable(2.0)
    process.send_signal(number)
    state = receive_until(host, lambda s: s.gate == FAULT)
    assert (state.fault, state.force_N) == ("DEVICE", 0.0)
    assert process.wait(120) == 0
    assert "zero force" in process.stdout.read()


@pytest.mark.parametrize("port", ["abc", "99999", "-1", "", "--help"])
def test_a_wrong_port_does_not_become_another(program, port):
    said = subprocess.run([program, port], capture_output=True, text=True, timeout=60)
    assert said.returncode == 2 and said.stdout == ""
    assert said.stderr.startswith("use: device_driver [PORT")


def test_a_wrong_limit_is_refused_in_a_sentence(program):
    said = subprocess.run([program, "0", "9"], capture_output=True, text=True)
    assert said.returncode == 2
    assert "max_ttl_s must be from 1e-6 to 1" in said.stderr
