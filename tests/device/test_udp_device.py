"""The UDP backend against a driver that knows only the layout of the packets."""

import numpy as np
import pytest
from struct_driver import ACTIVE, FAULT, IDLE, StructDriver
from waiting import wait_until

from drake_haptics.device.backend import DeviceCommand, DeviceError, Fault, GateState
from drake_haptics.device.udp_device import UdpDevice

AT_REST = np.array([1.0, 0, 0, 0, 0, 0, 0])
STILL = np.zeros(6)
PUSH = DeviceCommand(np.array([0, 0, 0, 2.0, 0, 0]), AT_REST, STILL)
LONG = {"ttl_s": 5.0, "hold_s": 5.0}  # nothing times out on a busy machine


@pytest.fixture
def driver():
    with StructDriver() as driver:
        yield driver


@pytest.fixture
def device(driver):
    with UdpDevice("127.0.0.1", driver.port, **LONG) as device:
        yield device


def test_a_reading_is_the_state_that_was_sent(driver, device):
    assert device.read() is None
    driver.receive()
    driver.exchange(
        X_BH=(0.6, 0, 0.8, 0, 1, 2, 3),
        V_BH=(1, 2, 3, 4, 5, 6),
        F_Ho_B=(0, 0, 0, 7, 8, 9),
        buttons=3,
    )
    wait_until(device.read)
    reading = device.read()
    np.testing.assert_allclose(reading.X_BH, [0.6, 0, 0.8, 0, 1, 2, 3])
    np.testing.assert_array_equal(reading.V_BH, [1, 2, 3, 4, 5, 6])
    np.testing.assert_array_equal(reading.F_Ho_B, [0, 0, 0, 7, 8, 9])
    assert (reading.buttons, reading.gate, reading.fault) == (
        3,
        GateState.IDLE,
        Fault.NONE,
    )
    assert device.read() is reading  # nothing new has come
    driver.exchange()
    wait_until(lambda: device.read().sequence == reading.sequence + 1)


def test_a_wrench_is_shown_with_its_slopes(driver, device):
    driver.receive()
    wait_until(lambda: driver.exchange(gate=IDLE).sequence > 3)
    assert not driver.exchange().enable
    K = np.diag([0, 0, 0, 50.0, 0, 0])
    device.write(DeviceCommand(PUSH.F_Ho_B, AT_REST, STILL, K, np.eye(6)))
    wait_until(lambda: driver.exchange(gate=IDLE).enable)
    wait_until(lambda: driver.exchange(gate=ACTIVE).F_Ho_B[3] == 2.0)
    X_BH, V_BH = (1, 0, 0, 0, 0.01, 0, 0), (0, 0, 0, 0.2, 0, 0)
    command = driver.exchange(X_BH=X_BH, V_BH=V_BH)
    np.testing.assert_allclose(command.F_Ho_B, [0, 0, 0, 2 - 0.5 - 0.2, 0, 0])


def test_a_fault_is_told_and_taken_back(driver, device):
    driver.receive()
    device.write(PUSH)
    wait_until(lambda: driver.exchange(gate=IDLE).enable)
    driver.exchange(gate=FAULT, fault=3)
    wait_until(lambda: device.read().gate == GateState.FAULT)
    assert device.read().fault == Fault.OVERSPEED
    device.recover()
    wait_until(lambda: not driver.exchange(gate=FAULT).enable)
    wait_until(lambda: driver.exchange(gate=IDLE, fault=0).enable)
    wait_until(lambda: device.read().gate == GateState.IDLE)


def test_the_way_is_counted(driver, device):
    assert device.get_link_status().lateness_s is None
    driver.receive()
    driver.exchange()
    driver.state.sequence += 5
    driver.exchange()
    driver.socket.sendto(b"nothing of ours", driver.peer)
    driver.exchange()
    wait_until(lambda: device.get_link_status().received == 3)
    status = device.get_link_status()
    assert (status.lost, status.rejected) == (5, 1)
    assert len(status.lateness_s) == 3


def test_it_may_be_closed_twice(driver, device):
    device.close()
    device.close()
    assert device.read() is None
    device.write(PUSH)
    device.recover()


def test_a_closed_device_rests_without_force(driver, device):
    driver.receive()
    device.write(PUSH)
    wait_until(lambda: driver.exchange(gate=IDLE).enable)
    driver.exchange(V_BH=np.ones(6), F_Ho_B=np.ones(6), gate=ACTIVE)
    wait_until(lambda: device.read().gate == GateState.ACTIVE)
    device.close()
    device.write(PUSH)
    device.recover()
    reading = device.read()
    assert (reading.gate, reading.fault) == (GateState.FAULT, Fault.DEVICE)
    assert not reading.F_Ho_B.any() and not reading.V_BH.any()


def test_an_address_that_cannot_be_is_told():
    with pytest.raises(DeviceError, match=r"no\.such\.host\.invalid"):
        UdpDevice("no.such.host.invalid", 7400)
    for port in (0, -1, 65536):
        with pytest.raises(ValueError, match=f"port must be from 1 to 65535.*{port}"):
            UdpDevice("127.0.0.1", port)
