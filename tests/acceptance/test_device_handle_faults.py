"""What the gate does when its own arm or clock goes wrong, in two processes."""

import sys

import pytest
from driver_process import SCRIPTED, WatchedLink, check_figures, running
from struct_host import FAULT, StructHost


@pytest.mark.parametrize(
    ("trouble", "fault"),
    [
        ("fast", "OVERSPEED"),
        ("spins", "OVERSPEED"),
        ("nan", "NOT_FINITE"),
        ("clock", "CLOCK"),
    ],
)
def test_a_driver_in_trouble_shows_no_force_until_it_is_disabled(
    tmp_path, trouble, fault
):
    file = tmp_path / "figures.json"
    command = [sys.executable, SCRIPTED, file, trouble]
    with running(command, file) as driver:
        with WatchedLink(driver.port) as link:
            host = StructHost(link.port)
            host.disable()
            state = host.exchange(lambda state: state.gate == FAULT, force_z=3.0)
            assert state.fault == fault
            # Latched, though the trouble itself is over.
            end = state.sequence + 200
            state = host.exchange(lambda state: state.sequence > end, force_z=3.0)
            assert (state.gate, state.fault) == (FAULT, fault)
            host.enable(3.0)
            host.disable()
            host.close()
            figures = driver.end()
        link.check_limits()
    check_figures(figures)
    assert figures["faults"] == figures["recoveries"] == {fault: 1}
