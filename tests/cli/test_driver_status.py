"""What `drake-haptics device` tells of a driver."""

import io
import itertools

import numpy as np
import pytest
from rich.console import Console
from struct_host import FAULT, StructHost

from drake_haptics.cli.status_line import DriverStatusLine, make_driver_summary
from drake_haptics.device.driver import DeviceDriver


class SteadyArm:
    """Moves at one speed for ever."""

    def start(self):
        """Nothing to switch on."""

    def step(self, F_Ho_B):
        """Returns where it would be."""
        return np.eye(7)[0], np.array([0.0, 0.0, 0.0, 0.3, 0.0, -0.4])


@pytest.fixture
def driver():
    """A driver whose every tick takes a millisecond of a clock of its own."""
    clock = itertools.count(10**9, 10**6 // 4)
    driver = DeviceDriver(
        SteadyArm(),
        max_force_N=8.5,
        max_torque_Nm=0.188,
        max_ttl_s=0.1,
        rate_hz=1000.0,
        bind="127.0.0.1",
        port=0,
        clock_ns=lambda: next(clock),
    )
    yield driver
    driver.run(1e-9)


@pytest.fixture
def host(driver):
    host = StructHost(driver.address[1])
    yield host
    host.close()


def write_line(driver, *, terminal=True):
    """Returns what the terminal gets when it is time for a line."""
    text = io.StringIO()
    console = Console(file=text, force_terminal=terminal, width=200, color_system=None)
    clock = itertools.count(0.0, 1.0)
    with DriverStatusLine(console, driver, clock=lambda: next(clock)) as status:
        status.update()
    return text.getvalue()


def bring_to_force(driver, host, force):
    """Takes the device to full force."""
    host.send(enable=False)
    driver.tick()
    for _ in range(300):
        host.send(force)
        driver.tick()
        host.receive(5.0)


def test_an_idle_device_says_so(driver):
    driver.tick()
    line = write_line(driver)
    assert "IDLE" in line and "0 commands, 0 refused" in line
    assert "0.50 m/s" in line and " 0.0 N" in line


def test_an_active_one_tells_force_and_packets(driver, host):
    bring_to_force(driver, host, 3.0)
    host.send_bytes(b"noise")
    driver.tick()
    line = write_line(driver)
    assert "ACTIVE" in line and "301 commands, 1 refused" in line
    assert " 3.0 N" in line


def test_a_fault_tells_why_and_for_how_long(driver, host):
    bring_to_force(driver, host, 3.0)
    while host.receive().gate != FAULT:
        driver.tick()
    line = write_line(driver)
    assert "FAULT (stale): until the host disables it" in line


def test_a_file_gets_no_line(driver):
    assert write_line(driver, terminal=False) == ""


def test_the_summary_has_the_figures(driver, host):
    bring_to_force(driver, host, 3.0)
    while host.receive().gate != FAULT:
        driver.tick()
    bring_to_force(driver, host, 1.0)
    host.send_bytes(b"noise")
    driver.tick()
    text = io.StringIO()
    Console(file=text, width=160).print(make_driver_summary(driver.to_dict()))
    said = text.getvalue()
    assert "602 accepted, 1 too short" in said
    assert "force 3.00 of 8.5 N, torque 0 of 188 mN·m" in said
    assert "over limits  0 ticks" in said
    assert said.count("1 stale") == 2  # a fault, and its recovery
