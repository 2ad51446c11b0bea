"""The docs' device over LCM in two processes over multicast, and what can go wrong."""

import os
import re
import signal
import socket
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pydrake.lcm import DrakeLcm
from waiting import wait_until

from drake_haptics.device.backend import DeviceCommand, Fault, GateState
from drake_haptics.device.lcm.lcm_device import LcmDevice

PAGE = (Path(__file__).parents[2] / "docs" / "connect-a-device.md").read_text(
    encoding="utf-8"
)
TEXT = PAGE[PAGE.index("## A device over LCM") :]
DEVICE, HOST = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


@pytest.fixture
def url(monkeypatch):
    """A multicast address of this test's own; skips where there is no multicast."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        url = f"udpm://239.255.76.67:{probe.getsockname()[1]}?ttl=0"
    try:
        DrakeLcm(url)
    except RuntimeError as error:
        pytest.skip(f"no UDP multicast here: {error}")
    monkeypatch.setenv("LCM_DEFAULT_URL", url)
    return url


@pytest.fixture
def start_device(url):
    """Starts the page's device as a process; all are ended at the end."""
    processes = []

    def start():
        processes.append(subprocess.Popen([sys.executable, "-c", DEVICE]))
        return processes[-1]

    yield start
    for process in processes:
        process.kill()
        process.wait(30)


def press(device):
    """One turn of a host's loop: 1 N upwards; leaves the fault of a pause."""
    reading = device.read()
    if reading is not None:
        if reading.fault is Fault.STALE:
            device.recover()
        F_Ho_B = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
        device.write(DeviceCommand(F_Ho_B, reading.X_BH, reading.V_BH))


def test_the_page_in_two_processes(start_device):
    start_device()
    with LcmDevice.open() as device:
        wait_until(lambda: device.read() is not None)
    process = subprocess.run(
        [sys.executable, "-c", HOST],
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ,
    )
    assert process.returncode == 0, process.stderr
    gate, force = process.stdout.split()
    # On a computer that stalls, the gate may have ended the loop's force.
    assert (gate, float(force)) in [
        ("ACTIVE", pytest.approx(1.5, abs=0.05)),
        ("FAULT", 0),
    ]


def test_host_paused_and_device_killed(url, start_device):
    process = start_device()
    with LcmDevice.open(url) as device:

        def is_in(gate, fault=Fault.NONE):
            reading = device.read()
            return reading is not None and (reading.gate, reading.fault) == (
                gate,
                fault,
            )

        def is_felt():
            return is_in(GateState.ACTIVE) and device.read().F_Ho_B[5] > 0.99

        wait_until(is_felt, lambda: press(device))
        # The host pauses: it only listens.
        wait_until(lambda: is_in(GateState.FAULT, Fault.STALE))
        assert not device.read().F_Ho_B.any()
        wait_until(is_felt, lambda: press(device))
        # The device is killed and another one started.
        process.send_signal(signal.SIGKILL)
        process.wait(30)
        last = device.read()
        wait_until(lambda: is_in(GateState.FAULT, Fault.DEVICE), lambda: press(device))
        start_device()
        wait_until(
            lambda: device.read().sequence > last.sequence + 100, lambda: press(device)
        )
        assert is_in(GateState.FAULT, Fault.DEVICE)
        assert not device.read().F_Ho_B.any()
        device.recover()
        wait_until(is_felt, lambda: press(device))
        assert np.linalg.norm(device.read().F_Ho_B[3:]) <= 1.0 + 1e-9


def test_figures_of_the_page():
    """The delay's price, and that every name exists."""
    from drake_haptics.device.lcm import haptic_messages
    from drake_haptics.loop import drivers

    period_s = 1e-3
    direct, later = 1.0 / (period_s / 2), 1.0 / (period_s / 2 + 2 * period_s)
    assert later / direct == pytest.approx(0.2)
    assert "a fifth of the stiffness" in TEXT
    for name in re.findall(r"`(lcmt_\w+)`", TEXT):
        assert hasattr(haptic_messages, name)
    assert hasattr(drivers, "AddLcmDriver")
