"""`drake-haptics device` and `drake-haptics run`, in two processes, as in use.

A host that is killed: test_killed_sides.py.
"""

import signal

import pytest
from driver_process import WatchedLink, check_figures, device_command, running
from host_process import hosting, is_not_active
from struct_host import ACTIVE, FAULT, IDLE

FELT_N = 0.5


@pytest.fixture(scope="module")
def device(tmp_path_factory):
    """A driver for all tests."""
    file = tmp_path_factory.mktemp("device") / "figures.json"
    with running(device_command(file, "--ttl-ms", 500), file) as driver:
        yield driver
        figures = driver.end()
    check_figures(figures)


@pytest.fixture
def host_file(tmp_path):
    """Where a host writes its figures."""
    return tmp_path / "host.json"


def is_felt(state):
    return state.gate == ACTIVE and state.force_N > FELT_N


def test_the_end_of_a_run_leaves_the_device_idle(link, host_file):
    with hosting(link.port, host_file, "--duration", 2) as host:
        host.wait()
        figures = host.end()
    last = link.wait_for(is_not_active)
    assert last.force_N == 0.0
    assert figures["duration_s"] == pytest.approx(2.0)
    assert figures["contacts"]["max"] >= 1
    assert figures["non_finite_events"] == 0
    assert figures["device"]["received"] > 100
    if not figures["device"]["faults"]:
        assert last.gate == IDLE


@pytest.mark.parametrize("numbers", [[signal.SIGINT] * 10, [signal.SIGTERM]])
def test_a_host_that_is_asked_to_end_leaves_the_device_idle(link, host_file, numbers):
    with hosting(link.port, host_file) as host:
        host.press_enter_until(link, is_felt)
        for number in numbers:
            host.send_signal(number)
        status, said = host.wait()
        assert status == 0, said
        assert host.end()["device"]["received"] > 100
    last = link.wait_for(lambda state: True)
    assert (last.gate, last.force_N) == (IDLE, 0.0)


def test_a_paused_host_needs_enter_before_anything_is_felt_again(link, host_file):
    with hosting(link.port, host_file) as host:
        host.press_enter_until(link, is_felt)
        host.send_signal(signal.SIGSTOP)
        last = link.wait_for(is_not_active)
        assert (last.gate, last.fault, last.force_N) == (FAULT, "STALE", 0.0)
        seen = len(link.states)
        host.send_signal(signal.SIGCONT)
        link.wait_for(lambda state: state.sequence > last.sequence + 1000)
        assert all(state.gate == FAULT for state in link.states[seen:])
        host.press_enter_until(link, is_felt)
        figures = host.end()
    assert figures["device"]["faults"]["STALE"] >= 1
    assert figures["device"]["recoveries"] >= 1


def test_a_driver_that_is_started_again_needs_enter_too(tmp_path, host_file):
    file = tmp_path / "figures.json"
    with running(device_command(file, "--ttl-ms", 500), file) as driver:
        with WatchedLink(driver.port) as link:
            with hosting(link.port, host_file) as host:
                host.press_enter_until(link, is_felt)
                driver.send_signal(signal.SIGKILL)
                before = link.states[-1]
                command = device_command(file, "--ttl-ms", 500, port=driver.port)
                with running(command, file) as again:
                    first = link.wait_for(lambda state: state.boot != before.boot)
                    assert first.gate == IDLE
                    link.wait_for(lambda state: state.sequence > first.sequence + 500)
                    new = [s for s in link.states if s.boot == first.boot]
                    assert all(state.gate == IDLE for state in new)
                    host.press_enter()
                    host.press_enter_until(link, is_felt)
                    host.end()
                    check_figures(again.end())
        link.check_limits()
