"""The native servo against a driver that knows only the layout of the packets."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from stalling_host import read_with_the_lock
from struct_driver import ACTIVE, FAULT, IDLE, StructDriver
from waiting import wait_until

from drake_haptics._core import UdpServo

AT_REST = np.array([1.0, 0, 0, 0, 0, 0, 0])
STILL = np.zeros(6)
PUSH = np.array([0, 0, 0, 2.0, 0, 0])
STALE, OVERSPEED, DEVICE = 1, 3, 5
LONG = {"ttl_s": 5.0, "hold_s": 5.0}  # nothing times out on a busy machine
SHORT = {"ttl_s": 1.0, "hold_s": 5.0}  # a driver is missed soon, and not too soon
SUPPORT = Path(__file__).parents[2] / "support"


@pytest.fixture
def driver():
    with StructDriver() as driver:
        yield driver


@pytest.fixture
def servo(driver):
    with closing(UdpServo("127.0.0.1", driver.port, **LONG)) as servo:
        yield servo


def publish(servo, F=PUSH, K=None):
    servo.publish(F, AT_REST, STILL, K, None)


def connect(driver, servo):
    """Handshake, first wrench, enabled: the next state is that of an active device."""
    assert not driver.receive().enable
    assert not driver.exchange(gate=IDLE).enable
    publish(servo)
    wait_until(lambda: driver.exchange(gate=IDLE).enable)
    assert driver.exchange(gate=ACTIVE).enable


def engage(driver, servo, **state):
    """Exchanges until all of the wrench is shown."""
    wait_until(lambda: driver.exchange(**state).enable and servo.status().scale == 1.0)


def test_it_asks_for_a_driver_and_enables_nothing(driver, servo):
    first, second = driver.receive(), driver.receive()
    for command in (first, second):
        assert not command.enable
        assert command.F_Ho_B == (0.0,) * 6
        assert command.session != 0
        assert command.ttl_us == 5_000_000
        assert command.state_sequence == 0
    assert second.sequence == first.sequence + 1
    assert second.session == first.session
    assert second.time_ns - first.time_ns > 40_000_000
    assert servo.read() is None


def test_a_wrench_before_the_driver_enables_nothing(driver, servo):
    publish(servo)
    time.sleep(0.1)
    commands = [driver.receive() for _ in range(3)]
    assert not any(command.enable for command in commands)


def test_every_run_has_a_session_of_its_own(driver):
    sessions = set()
    for _ in range(5):
        servo = UdpServo("127.0.0.1", driver.port)
        sessions.add(driver.receive().session)
        servo.close()
        driver.receive_all()
    assert len(sessions) == 5


def test_it_reads_every_field(driver, servo):
    driver.receive()
    driver.exchange(
        X_BH=(0.8, 0.6, 0, 0, 1, 2, 3),
        V_BH=(4, 5, 6, 7, 8, 9),
        F_Ho_B=(10, 11, 12, 13, 14, 15),
        buttons=5,
        max_force_N=3.5,
        max_torque_Nm=0.25,
    )
    wait_until(servo.read)
    state = servo.read()
    np.testing.assert_allclose(state.X_BH, [0.8, 0.6, 0, 0, 1, 2, 3], rtol=1e-15)
    np.testing.assert_array_equal(state.V_BH, [4, 5, 6, 7, 8, 9])
    np.testing.assert_array_equal(state.F_Ho_B, [10, 11, 12, 13, 14, 15])
    assert (state.buttons, state.max_force_N, state.max_torque_Nm) == (5, 3.5, 0.25)
    assert (state.gate, state.fault) == (IDLE, 0)
    assert 0 <= time.monotonic() - state.time_s < 60


def test_it_answers_each_state_with_the_local_wrench(driver, servo):
    connect(driver, servo)
    K = np.diag([0, 0, 0, 100.0, 0, 0])
    publish(servo, K=K)
    engage(driver, servo, gate=ACTIVE)
    for x in (0.0, 0.01, -0.02):
        command = driver.exchange(X_BH=(1, 0, 0, 0, x, 0, 0))
        np.testing.assert_allclose(command.F_Ho_B, [0, 0, 0, 2 - 100 * x, 0, 0])
    assert servo.status().is_active


def test_the_device_says_what_the_limits_are(driver, servo):
    connect(driver, servo)
    publish(servo, F=np.array([3.0, 0, 4, 0, 30, -40]))
    engage(driver, servo, gate=ACTIVE)
    command = driver.exchange(max_force_N=2.0, max_torque_Nm=0.5)
    np.testing.assert_allclose(command.F_Ho_B, [0.3, 0, 0.4, 0, 1.2, -1.6])
    command = driver.exchange(max_force_N=float("nan"), max_torque_Nm=-1.0)
    assert command.F_Ho_B == (0.0,) * 6


def test_the_host_may_allow_less_than_the_device(driver):
    with closing(
        UdpServo("127.0.0.1", driver.port, max_force_N=1.5, max_torque_Nm=0.1, **LONG)
    ) as servo:
        connect(driver, servo)
        # Within the limits when it was given, beyond them further in.
        publish(servo, F=np.array([0, 0, 0, 1.4, 0, 0]), K=1e3 * np.eye(6))
        engage(driver, servo, gate=ACTIVE)
        command = driver.exchange(X_BH=(1, 0, 0, 0, -0.01, 0, 0))
        np.testing.assert_allclose(command.F_Ho_B, [0, 0, 0, 1.5, 0, 0])
        command = driver.exchange(X_BH=(np.cos(0.1), np.sin(0.1), 0, 0, 0, 0, 0))
        np.testing.assert_allclose(command.F_Ho_B, [-0.1, 0, 0, 1.4, 0, 0], atol=1e-12)
        command = driver.exchange(max_force_N=float("nan"), max_torque_Nm=float("nan"))
        assert command.F_Ho_B == (0.0,) * 6


def test_a_wrench_that_is_not_renewed_is_released(driver):
    with closing(UdpServo("127.0.0.1", driver.port, ttl_s=5.0, hold_s=0.2)) as servo:
        connect(driver, servo)
        wait_until(lambda: publish(servo) or driver.exchange().F_Ho_B[3] > 0.0)
        wait_until(lambda: driver.exchange().F_Ho_B[3] == 0.0)
        time.sleep(0.05)
        command = driver.exchange()
        assert command.F_Ho_B == (0.0,) * 6
        assert command.enable


def test_what_is_late_lost_or_damaged_is_counted_and_not_used(driver, servo):
    driver.receive()
    driver.state.sequence = 2**32 - 3  # and across the wrap
    driver.exchange(X_BH=(1, 0, 0, 0, 1, 0, 0))
    driver.state.sequence += 4
    driver.exchange(X_BH=(1, 0, 0, 0, 2, 0, 0))
    driver.state.sequence -= 3  # two of the four come late
    driver.send(X_BH=(1, 0, 0, 0, 3, 0, 0))
    driver.state.sequence -= 1
    driver.send(X_BH=(1, 0, 0, 0, 4, 0, 0))
    packet = bytearray(driver.state.pack())
    packet[30] ^= 1
    driver.socket.sendto(packet, driver.peer)
    driver.socket.sendto(b"", driver.peer)
    driver.socket.sendto(bytes(2000), driver.peer)
    driver.state.sequence += 2
    nan = float("nan")
    driver.send(X_BH=(1, 0, 0, 0, nan, 0, 0))
    driver.send(X_BH=(0, 0, 0, 0, 0, 0, 0))
    driver.exchange(X_BH=(1, 0, 0, 0, 5, 0, 0))
    wait_until(lambda: servo.read().X_BH[4] == 5)
    status = servo.status()
    assert (status.late, status.duplicate) == (1, 1)
    assert (status.damaged, status.not_finite) == (3, 2)
    # Three of four, and the two that were not finite.
    assert status.lost == 5
    assert status.received == 5


def test_what_another_peer_sends_is_not_taken(driver, servo):
    driver.receive()
    driver.exchange()
    before = servo.status()
    with StructDriver() as other:
        other.peer = ("127.0.0.1", servo.local_port)
        for _ in range(10):
            other.send(X_BH=(1, 0, 0, 0, 9, 0, 0), sequence=1000)
        driver.exchange(X_BH=(1, 0, 0, 0, 1, 0, 0))
    wait_until(lambda: servo.read().X_BH[4] == 1)
    assert servo.status().received == before.received + 1
    assert servo.status().damaged == 0


def test_a_fault_stays_until_it_is_recovered(driver, servo):
    connect(driver, servo)
    engage(driver, servo, gate=ACTIVE)
    for _ in range(5):
        command = driver.exchange(gate=FAULT, fault=OVERSPEED)
        # It is left at fault: a command that disables would clear that.
        assert command.enable
        assert command.F_Ho_B == (0.0,) * 6
    wait_until(lambda: servo.read().gate == FAULT)
    assert servo.read().fault == OVERSPEED
    # Nor does the device's own way out of the fault enable it again.
    assert not driver.exchange(gate=IDLE, fault=0).enable
    wait_until(lambda: servo.read().number == servo.status().received)
    assert (servo.read().gate, servo.read().fault) == (FAULT, OVERSPEED)
    driver.exchange(gate=FAULT, fault=OVERSPEED)
    servo.recover()
    wait_until(lambda: not driver.exchange(gate=FAULT).enable)
    assert driver.exchange(gate=IDLE, fault=0).enable
    command = driver.exchange(gate=ACTIVE)
    assert 0.0 < command.F_Ho_B[3] < 0.5  # engages again


def test_a_driver_that_was_restarted_is_not_enabled(driver, servo):
    connect(driver, servo)
    late = driver.state
    command = driver.exchange(boot=8, gate=IDLE, sequence=0)
    assert not command.enable
    assert command.F_Ho_B == (0.0,) * 6
    # One of the former run that comes late is no further restart.
    driver.socket.sendto(late.pack(), driver.peer)
    assert not driver.exchange().enable
    wait_until(lambda: servo.read().gate == FAULT)
    assert servo.read().fault == DEVICE
    assert (servo.status().restarts, servo.status().late) == (1, 1)
    servo.recover()
    wait_until(lambda: driver.exchange().enable)
    assert servo.read().number > 2


def test_a_driver_that_is_silent_is_looked_for_disabled(driver):
    with closing(UdpServo("127.0.0.1", driver.port, **SHORT)) as servo:
        connect(driver, servo)
        wait_until(lambda: not driver.receive().enable)
        state = servo.read()
        assert (state.gate, state.fault) == (FAULT, STALE)
        assert not servo.status().is_heard
        assert servo.status().silences >= 1
        # It comes back, is found, and stays disabled until it is recovered.
        wait_until(
            lambda: driver.exchange(gate=IDLE).sequence and servo.status().is_heard
        )
        assert not driver.exchange(gate=IDLE).enable
        servo.recover()
        wait_until(lambda: driver.exchange(gate=IDLE).enable)


def test_a_driver_that_has_gone_is_not_active_because_it_is_wanted_back(driver):
    with closing(UdpServo("127.0.0.1", driver.port, **SHORT)) as servo:
        connect(driver, servo)
        engage(driver, servo, gate=ACTIVE)
        wait_until(lambda: not driver.receive().enable)
        servo.recover()
        # The thread has seen it by its second command from here on.
        for _ in range(3):
            assert not driver.receive().enable
        assert (servo.read().gate, servo.read().fault) == (FAULT, STALE)
        wait_until(lambda: driver.exchange(gate=IDLE, boot=8).enable)
        wait_until(lambda: servo.read().gate == IDLE)


def test_after_a_flood_only_the_newest_state_is_answered(driver):
    with closing(UdpServo("127.0.0.1", driver.port, max_rate_hz=20.0, **LONG)) as servo:
        driver.receive()
        start = time.monotonic()
        for _ in range(60):  # fewer than the system's buffer holds
            driver.send()
        last = driver.exchange()
        assert last.sequence <= 4 + 20 * (time.monotonic() - start)
        wait_until(lambda: servo.status().received == 61)


def test_closing_disables_several_times_and_may_be_repeated(driver, servo):
    connect(driver, servo)
    driver.receive_all()
    servo.close()
    commands = driver.receive_all()
    assert [command.enable for command in commands[-5:]] == [False] * 5
    assert all(command.F_Ho_B == (0.0,) * 6 for command in commands[-5:])
    servo.close()
    servo.recover()
    publish(servo)
    time.sleep(0.1)
    assert driver.receive_all() == []
    assert not servo.status().is_running


def test_a_servo_that_is_dropped_is_closed(driver):
    servo = UdpServo("127.0.0.1", driver.port, **LONG)
    connect(driver, servo)
    del servo
    assert not driver.receive_all()[-1].enable


def test_a_closed_socket_on_the_other_side_is_silence(driver):
    """The system tells by an error that nobody listens there."""
    with StructDriver() as gone:
        port = gone.port
    with closing(UdpServo("127.0.0.1", port)) as servo:
        wait_until(lambda: servo.status().sent >= 5)
        assert servo.status().is_running
        assert servo.read() is None


def test_it_speaks_ipv6():
    try:
        driver = StructDriver("::1")
    except OSError:
        pytest.skip("no IPv6 here")
    with driver:
        with closing(UdpServo("::1", driver.port, **LONG)) as servo:
            connect(driver, servo)
            assert servo.local_port > 0


def test_a_fork_neither_hangs_nor_disables_the_device(driver, servo):
    connect(driver, servo)
    child = os.fork()
    if child == 0:
        servo.close()
        os._exit(7)
    _, code = os.waitpid(child, 0)
    assert os.waitstatus_to_exitcode(code) == 7
    assert driver.exchange().enable


PROGRAM = """
import numpy as np, sys, time
from drake_haptics._core import UdpServo
servo = UdpServo("127.0.0.1", int(sys.argv[1]), ttl_s=5.0, hold_s=5.0)
servo.publish(np.zeros(6), np.eye(7)[0], np.zeros(6), None, None)
while not servo.status().is_active:
    time.sleep(1e-3)
print("ready", flush=True)
time.sleep(float(sys.argv[2]))
"""


def start_program(driver, sleep_s):
    program = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, str(driver.port), str(sleep_s)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    driver.receive(60.0)
    wait_until(lambda: driver.exchange(gate=IDLE).enable)
    assert program.stdout.readline() == "ready\n"
    return program


def test_ctrl_c_reaches_the_program_and_ends_at_zero_force(driver):
    program = start_program(driver, 60)
    try:
        program.send_signal(signal.SIGINT)
        _, said = program.communicate(timeout=120)
        assert "KeyboardInterrupt" in said
        assert not driver.receive_all()[-1].enable
    finally:
        program.kill()


def test_a_program_that_forgets_to_close_ends(driver):
    program = start_program(driver, 0)
    try:
        _, said = program.communicate(timeout=120)
        assert (program.returncode, said) == (0, "")
        assert not driver.receive_all()[-1].enable
    finally:
        program.kill()


def test_it_answers_while_python_is_stalled_and_shows_nothing_stale():
    """The driver is another process; here one call keeps the lock until it has seen."""
    driver = subprocess.Popen(
        [sys.executable, SUPPORT / "struct_driver.py"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        bufsize=0,
    )
    servo = UdpServo("127.0.0.1", int(driver.stdout.readline()), ttl_s=5.0)
    try:
        publish(servo)
        wait_until(lambda: servo.read() and servo.read().gate == ACTIVE)
        wait_until(lambda: publish(servo) or servo.status().scale == 1.0)
        driver.stdin.write(b"!")
        assert read_with_the_lock(driver.stdout.fileno()) == b"s"
        assert servo.status().is_active
    finally:
        servo.close()
        driver.kill()
        driver.wait(60)
        driver.stdin.close()
        driver.stdout.close()


@pytest.mark.parametrize(
    ("name", "value"), [("ttl_s", 0.0), ("max_rate_hz", -1.0), ("hold_s", float("nan"))]
)
def test_options_must_be_positive(name, value):
    with pytest.raises(ValueError, match=f"{name}.*above 0"):
        UdpServo("127.0.0.1", 7400, **{name: value})


@pytest.mark.parametrize("value", [-1.0, float("nan")])
@pytest.mark.parametrize("name", ["max_force_N", "max_torque_Nm"])
def test_limits_must_not_be_negative(name, value):
    with pytest.raises(ValueError, match=r"max_force_N and max_torque_Nm.*at least 0"):
        UdpServo("127.0.0.1", 7400, **{name: value})


def test_a_host_that_is_not_there_is_told():
    with pytest.raises(RuntimeError, match=r"host 'no\.such\.host\.invalid' was not"):
        UdpServo("no.such.host.invalid", 7400)


def test_lateness_is_measured(driver, servo):
    assert servo.lateness_s() == (0.0, 0.0, 0.0)
    driver.receive()
    for _ in range(100):
        driver.exchange()
    wait_until(lambda: servo.status().received == 100)
    p50, p99, p999 = servo.lateness_s()
    assert 0.0 < p50 <= p99 <= p999 < 60.0


def test_the_socket_of_a_test_is_our_own():
    """The port of a closed servo is free again."""
    with StructDriver() as driver:
        servo = UdpServo("127.0.0.1", driver.port)
        port = servo.local_port
        servo.close()
        del servo
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as again:
            again.bind(("127.0.0.1", port))
